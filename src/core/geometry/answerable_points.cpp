#include "core/geometry/answerable_points.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

namespace {

/// \return the number of distinct points, counted up to \p most.
int countDistinct(const PointsRef& points, int most) {
  std::vector<Eigen::Vector3f> distinct;
  for (Eigen::Index i = 0; i < points.cols() && static_cast<int>(distinct.size()) < most; ++i) {
    const Eigen::Vector3f point = points.col(i);
    if (std::find(distinct.begin(), distinct.end(), point) == distinct.end()) distinct.push_back(point);
  }
  return static_cast<int>(distinct.size());
}

Eigen::Vector3d farthestFrom(const Eigen::Vector3d& position, const PointsRef& points) {
  Eigen::Index farthest = 0;
  (points.cast<double>().colwise() - position).colwise().squaredNorm().maxCoeff(&farthest);
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
  // Rounding moves a point by sqrt(3) 2^-24 of its distance from the origin, and the line through two others as much.
  const double rounding =
      2.0 * std::numeric_limits<float>::epsilon() * farthestFrom(Eigen::Vector3d::Zero(), points).norm();
  if (length <= rounding) return "all points are at one position, up to the rounding of their coordinates";
  const Eigen::Vector3d direction = (last - first) / length;
  const double thickness = std::max(kGeometry.line_thickness * length, rounding);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d offset = points.col(i).cast<double>() - first;
    if ((offset - direction.dot(offset) * direction).norm() > thickness) return {};
  }
  return "all points lie on one line";
}

}  // namespace pcl_symmetry
