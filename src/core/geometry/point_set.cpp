#include "pcl_symmetry/core/point_set.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

namespace {

struct Farthest {
  Eigen::Index index = 0;
  double sq_distance = -1.0;
};

/// The point that is the farthest from a center, of every stride-th one.
Farthest farthestFrom(const Eigen::Vector3d& center, const PointsRef& points, Eigen::Index stride) {
  Farthest farthest;
  for (Eigen::Index i = 0; i < points.cols(); i += stride) {
    const double dx = points(0, i) - center.x(), dy = points(1, i) - center.y(), dz = points(2, i) - center.z();
    const double sq_distance = dx * dx + dy * dy + dz * dz;
    if (sq_distance > farthest.sq_distance) farthest = {i, sq_distance};
  }
  return farthest;
}

}  // namespace

BoundingBall boundingBall(const PointsRef& points) {
  BoundingBall ball;
  if (points.cols() == 0) return ball;
  const Eigen::Index stride = std::max<Eigen::Index>(1, points.cols() / kGeometry.ball_points);
  ball.center = centerOfMass(points);
  for (int i = 1; i <= kGeometry.ball_iterations; ++i) {
    const Eigen::Index farthest = farthestFrom(ball.center, points, stride).index;
    ball.center += (points.col(farthest).cast<double>() - ball.center) / (i + 1.0);
  }
  ball.radius = std::sqrt(farthestFrom(ball.center, points, 1).sq_distance);
  return ball;
}

Eigen::Vector3d centerOfMass(const PointsRef& points) {
  if (points.cols() == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d first = points.col(0).cast<double>();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) sum += points.col(i).cast<double>() - first;
  return first + sum / static_cast<double>(points.cols());
}

Points normalizePoints(const PointsRef& points, const Eigen::Vector3d& center, double scale) {
  Points normalized(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    normalized.col(i) = ((points.col(i).cast<double>() - center) / scale).cast<float>();
  return normalized;
}

}  // namespace pcl_symmetry
