#pragma once

#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/plane_types.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A point of the curve whose rotation about an axis gives a body of revolution.
struct ProfilePoint {
  double radius;  ///< distance from the axis, input units, >= 0
  double height;  ///< along the direction of the axis, from its point, input units
  double spread;  ///< standard deviation of the points about the curve there, input units
  int count;      ///< points that decide there
};

/// The profile of a body of revolution: its points in (radius, height), averaged along the curve that they make. Each
/// point of the curve is where a parabola fitted to the points nearby passes, so that the average follows its bends.
/// \param points 3 x N, input units; those that are not finite are left out.
/// \param axis of revolution, input frame.
/// \param num_points of the curve, about, >= 2.
/// \return points in order along the curve, from the lower of its ends; points of other pieces follow.
/// \throws std::invalid_argument for fewer than 20 finite points.
std::vector<ProfilePoint> revolutionProfile(const PointsRef& points, const SymmetryAxis& axis, int num_points = 200);

}  // namespace pcl_symmetry
