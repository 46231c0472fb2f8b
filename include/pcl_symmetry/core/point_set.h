#pragma once

#include <Eigen/Core>

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// 3 x N points, one a column, finite.
using Points = Eigen::Matrix3Xf;
/// A view of 3 x N points held elsewhere. Columns may lie at any distance, so that PCL clouds need no copy.
using PointsRef = Eigen::Ref<const Eigen::Matrix3Xf, 0, Eigen::OuterStride<>>;

/// A ball that contains every point.
struct BoundingBall {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< input frame
  double radius = 0.0;                               ///< input units
};

/// A ball around the points whose radius is within about 1 % of the smallest, by core-set iteration (Badoiu and
/// Clarkson 2003). Unlike a box, it rotates, moves and scales with the points.
/// \param points 3 x N, finite; otherwise the center is not finite.
/// \return radius 0 for one point or coincident points; the ball of radius 0 about the origin without a point.
BoundingBall boundingBall(const PointsRef& points);

/// \param points 3 x N, finite.
/// \return mean of the points, input frame; the origin without a point.
Eigen::Vector3d centerOfMass(const PointsRef& points);

/// Moves points to the origin and scales them.
/// \param points 3 x N, finite.
/// \param scale not zero.
/// \return (points - center) / scale, computed in double.
Points normalizePoints(const PointsRef& points, const Eigen::Vector3d& center, double scale);

}  // namespace pcl_symmetry
