#pragma once

#include <Eigen/Core>

namespace pcl_symmetry {

/// 3 x N points, finite, float, column by column.
using Points = Eigen::Matrix3Xf;
/// Points that somebody else holds; N columns at any distance, so that PCL clouds need no copy.
using PointsRef = Eigen::Ref<const Eigen::Matrix3Xf, 0, Eigen::OuterStride<>>;

/// A ball that holds every point.
struct BoundingBall {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

/// Nearly the smallest ball around the points (within about 1 %), by core-set iteration (Badoiu and Clarkson 2003): it
/// turns, moves and scales with the points, as a box would not.
/// \param points 3 x N, finite. \return radius 0 for one point or coincident points.
BoundingBall boundingBall(const PointsRef& points);

/// Mean of the points; zero where there is none.
Eigen::Vector3d centerOfMass(const PointsRef& points);

/// (points - center) / scale, computed in double.
Points normalizePoints(const PointsRef& points, const Eigen::Vector3d& center, double scale);

}  // namespace pcl_symmetry
