#pragma once

#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/plane_types.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A point of the curve whose rotation about an axis gives a body of revolution.
struct ProfilePoint {
  double radius;  ///< distance from the axis, input units, >= 0
  double height;  ///< position along the axis, measured from SymmetryAxis::point, input units
  double spread;  ///< standard deviation of the points about the curve there, input units
  int count;      ///< number of points that the average and the spread are taken over
};

/// The profile of a body of revolution: its points in (radius, height), averaged along the curve that they form. Each
/// point of the curve lies on a parabola fitted to the points nearby, so that the average follows the bends.
/// \param points 3 x N, input units; those that are not finite are left out.
/// \param axis axis of revolution, input frame.
/// \param num_points approximate number of points of the curve, >= 2.
/// \return points in order along the curve, from the lower of its ends; points of other pieces follow.
/// \throws std::invalid_argument for fewer than 20 finite points.
std::vector<ProfilePoint> revolutionProfile(const PointsRef& points, const SymmetryAxis& axis, int num_points = 200);

}  // namespace pcl_symmetry
