#include "pcl_symmetry/core/geometry/point_set.h"

#include <algorithm>
#include <cmath>

namespace pcl_symmetry {

namespace {

/// The point farthest from \p center among every \p stride-th point.
/// \return its index and its distance.
std::pair<Eigen::Index, double> farthest(const PointsRef& points, const Eigen::Vector3d& center, Eigen::Index stride) {
  const Eigen::Vector3d c = center;
  Eigen::Index index = 0;
  double sq_largest = -1.0;
  for (Eigen::Index i = 0; i < points.cols(); i += stride) {
    const double dx = points(0, i) - c.x(), dy = points(1, i) - c.y(), dz = points(2, i) - c.z();
    const double sq_distance = dx * dx + dy * dy + dz * dz;
    if (sq_distance > sq_largest) {
      sq_largest = sq_distance;
      index = i;
    }
  }
  return {index, std::sqrt(std::max(0.0, sq_largest))};
}

}  // namespace

BoundingBall boundingBall(const PointsRef& points) {
  BoundingBall ball;
  if (points.cols() == 0) return ball;
  // chosen: half as many points miss more of the outermost ones, twice as many double the time
  constexpr Eigen::Index kNumProbed = 2'500;
  // chosen: the radius is within about 1 % of the smallest; half as many leave it farther off, twice as many take twice
  // the time
  constexpr int kNumIterations = 60;
  const Eigen::Index stride = std::max<Eigen::Index>(1, points.cols() / kNumProbed);
  ball.center = centerOfMass(points);
  for (int i = 1; i <= kNumIterations; ++i) {
    const auto [index, distance] = farthest(points, ball.center, stride);
    ball.center += (points.col(index).cast<double>() - ball.center) / (i + 1.0);
  }
  ball.radius = farthest(points, ball.center, 1).second;
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
