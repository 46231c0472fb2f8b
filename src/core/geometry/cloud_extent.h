/// How far a cloud extends: its principal axes and its diameter.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Center of mass and principal axes of a point set (PCA).
struct PrincipalAxes {
  Eigen::Vector3d center;     ///< center of mass, input frame
  Eigen::Matrix3d axes;       ///< columns: unit, right-handed, by decreasing variance
  Eigen::Vector3d variances;  ///< variances along the axes, input units squared, decreasing
};

/// \param points 3 x N, finite, N >= 1.
/// \throws std::invalid_argument without a point.
PrincipalAxes principalAxes(const PointsRef& points);

/// The three planes through the center of mass that are perpendicular to the principal axes: candidates for planes of
/// symmetry at almost no cost.
std::vector<ReflectionPlane> principalPlanes(const PrincipalAxes& axes);

/// Whether a shape is solid, a sheet or a line at a tolerance. Reflections along thin directions move no point and are
/// uninformative.
enum class Thinness {
  Solid,
  Sheet,  ///< 97 % of the points lie within the plane tolerance of one plane
  Line    ///< 97 % of the points lie within the line tolerance of one line
};

/// \param points 3 x N, finite, N >= 1.
/// \param axes principal axes of the points.
/// \param plane_tolerance,line_tolerance greatest distances of points from a plane and from a line, units of the
/// points, > 0.
Thinness thinnessOf(const PointsRef& points, const PrincipalAxes& axes, double plane_tolerance, double line_tolerance);

/// \param points 3 x N, N >= 1.
/// \return the diagonal of the box around them along the coordinate axes.
inline double boxDiagonal(const PointsRef& points) {
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).cast<double>().norm();
}

/// The distance between two points that are each the farthest from the other: the diameter of most shapes, and never
/// less than 1 / sqrt(3) of the diameter. Takes a few passes over the points, whatever their shape.
/// \param points 3 x N, finite, input units.
/// \return distance, input units; 0 for fewer than two points.
double approximateDiameter(const PointsRef& points);

}  // namespace pcl_symmetry
