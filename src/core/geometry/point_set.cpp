#include "pcl_symmetry/core/point_set.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/lists.h"
#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

namespace {

double sqDistance(const PointsRef& points, Eigen::Index i, const Eigen::Vector3d& center) {
  const double dx = points(0, i) - center.x(), dy = points(1, i) - center.y(), dz = points(2, i) - center.z();
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace

BoundingBall boundingBall(const PointsRef& points) {
  BoundingBall ball;
  if (points.cols() == 0) return ball;
  const Eigen::Index stride = std::max<Eigen::Index>(1, points.cols() / kGeometry.ball_points);
  ball.center = centerOfMass(points);
  const Eigen::Vector3d start = ball.center;
  std::vector<std::pair<double, Eigen::Index>> outermost;  // first: distances from the start
  for (Eigen::Index i = 0; i < points.cols(); i += stride)
    outermost.emplace_back(std::sqrt(sqDistance(points, i, start)), i);
  sortDescending(outermost, [](const auto& entry) { return entry.first; });
  for (int k = 1; k <= kGeometry.ball_iterations; ++k) {
    const double moved = (ball.center - start).norm();
    double greatest = -1.0;
    Eigen::Index farthest = 0;
    for (const auto& [distance, i] : outermost) {
      const double max_distance = (1.0 + 1e-9) * (distance + moved);
      if (max_distance * max_distance < greatest) break;  // nor is any of the following points farther
      const double sq_distance = sqDistance(points, i, ball.center);
      if (sq_distance < greatest || (sq_distance == greatest && i > farthest)) continue;
      greatest = sq_distance;
      farthest = i;
    }
    ball.center += (points.col(farthest).cast<double>() - ball.center) / (k + 1.0);
  }
  double greatest = -1.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) greatest = std::max(greatest, sqDistance(points, i, ball.center));
  ball.radius = std::sqrt(greatest);
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
