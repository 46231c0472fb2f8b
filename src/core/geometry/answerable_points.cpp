#include "core/geometry/answerable_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace pcl_symmetry {

namespace {

// Share of the length of a line. chosen: five times the rounding of a line about the origin; at half, a line that was
// turned and moved in float may pass for a surface, at twice nothing changes, as no surface is that thin.
constexpr double kLineThickness = 1e-6;
// Share of the largest distance from the origin. derived: rounding moves a point by at most sqrt(3) 2^-24 of that, and
// moves the line through two rounded points as much again.
constexpr double kRounding = 2.0 * std::numeric_limits<float>::epsilon();

/// \return the number of distinct points, counted up to \p most.
int countDistinct(const PointsRef& points, int most) {
  std::vector<Eigen::Vector3f> distinct;
  for (Eigen::Index i = 0; i < points.cols() && static_cast<int>(distinct.size()) < most; ++i) {
    const Eigen::Vector3f point = points.col(i);
    if (std::find(distinct.begin(), distinct.end(), point) == distinct.end()) distinct.push_back(point);
  }
  return static_cast<int>(distinct.size());
}

Eigen::Vector3d farthestFrom(const Eigen::Vector3d& place, const PointsRef& points) {
  Eigen::Index farthest = 0;
  double sq_largest = -1.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double sq_distance = (points.col(i).cast<double>() - place).squaredNorm();
    if (sq_distance <= sq_largest) continue;
    sq_largest = sq_distance;
    farthest = i;
  }
  return points.col(farthest).cast<double>();
}

}  // namespace

std::string whyUnanswerable(const PointsRef& points) {
  if (!points.allFinite()) throw std::invalid_argument("points: a coordinate is not finite");
  const int num_distinct = countDistinct(points, kMinDistinctPoints);
  if (num_distinct < kMinDistinctPoints)
    return std::to_string(num_distinct) +
           (num_distinct == 1 ? " distinct point, at least " : " distinct points, at least ") +
           std::to_string(kMinDistinctPoints) + " are needed";
  // The ends of a line: the point farthest from any of its points, and the one farthest from that.
  const Eigen::Vector3d first = farthestFrom(points.col(0).cast<double>(), points);
  const Eigen::Vector3d last = farthestFrom(first, points);
  const double length = (last - first).norm();
  const double rounding = kRounding * farthestFrom(Eigen::Vector3d::Zero(), points).norm();
  if (length <= rounding) return "all points are at one place, up to the rounding of their coordinates";
  const Eigen::Vector3d direction = (last - first) / length;
  const double thickness = std::max(kLineThickness * length, rounding);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d offset = points.col(i).cast<double>() - first;
    if ((offset - direction.dot(offset) * direction).norm() > thickness) return {};
  }
  return "all points lie on one line";
}

}  // namespace pcl_symmetry
