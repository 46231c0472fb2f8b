#include "pcl_symmetry/core/point_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/base/simd.h"
#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

namespace {

/// \return the greatest distance of a point from \p center.
double farthestFrom(const PointsRef& points, const Eigen::Vector3d& center) {
  const Eigen::Vector3d c = center;
  double sq_largest = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double dx = points(0, i) - c.x(), dy = points(1, i) - c.y(), dz = points(2, i) - c.z();
    sq_largest = std::max(sq_largest, dx * dx + dy * dy + dz * dz);
  }
  return std::sqrt(sq_largest);
}

/// Squared distances of some points from a center, coordinate by coordinate.
/// \return the greatest.
PCL_SYMMETRY_MULTIVERSION
double sqDistancesFrom(const double* center, const double* x, const double* y, const double* z, std::size_t size,
                       double* sq_distances) {
  const double cx = center[0], cy = center[1], cz = center[2];
#pragma GCC ivdep
  for (std::size_t i = 0; i < size; ++i) {
    const double dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
    sq_distances[i] = dx * dx + dy * dy + dz * dz;
  }
  // Bits of numbers >= 0 are in the order of their values, and the greatest of integers takes no branch.
  std::int64_t greatest = 0;
  for (std::size_t i = 0; i < size; ++i) {
    std::int64_t bits;
    std::memcpy(&bits, sq_distances + i, sizeof bits);
    greatest = std::max(greatest, bits);
  }
  double sq_greatest;
  std::memcpy(&sq_greatest, &greatest, sizeof greatest);
  return sq_greatest;
}

}  // namespace

BoundingBall boundingBall(const PointsRef& points) {
  BoundingBall ball;
  if (points.cols() == 0) return ball;
  const Eigen::Index stride = std::max<Eigen::Index>(1, points.cols() / kGeometry.ball_points);
  ball.center = centerOfMass(points);
  std::array<std::vector<double>, 3> probed;
  for (Eigen::Index i = 0; i < points.cols(); i += stride)
    for (int axis = 0; axis < 3; ++axis) probed[axis].push_back(points(axis, i));
  std::vector<double> sq_distances(probed[0].size());
  for (int i = 1; i <= kGeometry.ball_iterations; ++i) {
    const double sq_greatest = sqDistancesFrom(ball.center.data(), probed[0].data(), probed[1].data(), probed[2].data(),
                                               sq_distances.size(), sq_distances.data());
    const auto farthest = std::find(sq_distances.begin(), sq_distances.end(), sq_greatest);
    if (farthest == sq_distances.end()) break;  // a point that is not finite: so is the center
    const auto index = farthest - sq_distances.begin();
    const Eigen::Vector3d farthest_point(probed[0][index], probed[1][index], probed[2][index]);
    ball.center += (farthest_point - ball.center) / (i + 1.0);
  }
  ball.radius = farthestFrom(points, ball.center);
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
