#include "core/detection/plane_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/random.h"
#include "core/base/statistics.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

/// The number of points that resolve a surface at the tolerance: it grows with the inverse square of their spacing.
double maxPoints(const PointsRef& points, const DetectionOptions& options) {
  const double tolerance =
      options.absolute_tolerance > 0.0 ? options.absolute_tolerance / approximateDiameter(points) : options.tolerance;
  const double finer = std::max(1.0, DetectionOptions().tolerance / tolerance);
  return kDetection.points.max_points * finer * finer;
}

/// Slope of the logarithm of the density.
/// \param at positions at which the density is measured.
Eigen::Vector3d densitySlope(const NormalizedCloud& cloud, const Points& at) {
  std::vector<int> unused;
  std::vector<float> sq_distances, to_neighbor;
  cloud.search->search(at, kDetection.points.max_counted, unused, sq_distances);
  for (std::size_t i = kDetection.points.neighbors; i < sq_distances.size(); i += kDetection.points.max_counted)
    to_neighbor.push_back(sq_distances[i]);
  const float sq_radius = median(std::move(to_neighbor));
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d pull = Eigen::Vector4d::Zero();
  for (Eigen::Index i = 0; i < at.cols(); ++i) {
    const auto first = sq_distances.begin() + i * kDetection.points.max_counted;
    const auto count = std::upper_bound(first, first + kDetection.points.max_counted, sq_radius) - first;
    const Eigen::Vector4d position = at.col(i).cast<double>().homogeneous();
    squares += position * position.transpose();
    pull += std::log(static_cast<double>(count)) * position;
  }
  squares.diagonal().array() += 1e-9 * squares.trace();  // the points of a plane have no slope along its normal
  return solveSymmetric(squares, pull).head<3>();
}

}  // namespace

std::optional<std::vector<int>> drawSubset(const PointsRef& points, const DetectionOptions& options) {
  const double max_points = maxPoints(points, options);
  if (static_cast<double>(points.cols()) <= max_points) return std::nullopt;
  const DistinctPoints distinct(points);
  if (static_cast<double>(distinct.points.cols()) <= max_points) return std::nullopt;
  std::vector<int> kept = spreadSubset(distinct.points, static_cast<std::size_t>(max_points), options.seed);
  for (int& i : kept) i = distinct.first_of[i];
  return kept;
}

void spreadSupport(Detection& detection, const std::vector<int>& representative_of) {
  const auto spread = [&](SymmetryPlane& plane) {
    std::vector<float> support(representative_of.size(), 0.0f);
    for (std::size_t i = 0; i < support.size(); ++i)
      if (representative_of[i] >= 0) support[i] = plane.point_support[representative_of[i]];
    plane.point_support = std::move(support);
  };
  for (SymmetryPlane& plane : detection.planes) spread(plane);
  if (detection.best) spread(*detection.best);
}

std::vector<int> thinToEvenDensity(const NormalizedCloud& cloud, std::uint64_t seed) {
  const Eigen::Index size = cloud.points.cols();
  if (size <= kDetection.points.max_counted) return allIndices(size);
  const Points at = pointsAt(cloud.points, drawSamples(size, kDetection.points.density_samples, seed));
  const Eigen::Vector3d slope = densitySlope(cloud, at);
  std::vector<double> along;
  for (Eigen::Index i = 0; i < at.cols(); ++i) along.push_back(slope.dot(at.col(i).cast<double>()));
  const double low = quantile(along, kDetection.points.trimmed),
               high = quantile(along, 1.0 - kDetection.points.trimmed);
  const double strength = std::clamp(
      (high - low - kDetection.points.uneven) / (kDetection.points.fully_uneven - kDetection.points.uneven), 0.0, 1.0);
  if (strength == 0.0) return allIndices(size);
  RandomStream random(seed);
  std::vector<int> kept;
  for (Eigen::Index i = 0; i < size; ++i) {
    const double above = slope.dot(cloud.points.col(i).cast<double>()) - low;
    if (random.uniform() < std::exp(-strength * above)) kept.push_back(static_cast<int>(i));
  }
  return kept;
}

}  // namespace pcl_symmetry
