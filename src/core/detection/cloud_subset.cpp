#include "core/detection/cloud_subset.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/median.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/detection/detection_rules.h"
#include "core/geometry/diameter.h"
#include "core/geometry/distinct_points.h"
#include "core/geometry/point_samples.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// As many points as show a surface at the tolerance: their number grows as the square of what the spacing falls by.
double mostPoints(const PointsRef& points, const DetectionOptions& options) {
  const double tolerance =
      options.absolute_tolerance > 0.0 ? options.absolute_tolerance / farthestPair(points) : options.tolerance;
  const double finer = std::max(1.0, kDetection.points.usual_tolerance / tolerance);
  return kDetection.points.most_points * finer * finer;
}

}  // namespace

std::vector<int> CloudSubset::nearTo(const PointsRef& all, int num_threads) const {
  std::vector<int> near(beside);
  std::vector<char> is_far(near.size(), 0);
  const Eigen::Index last = points.cols() - 1;
  const Eigen::Vector3f extent = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
  const float sq_reach =
      kDetection.points.subset_reach * kDetection.points.subset_reach * extent.maxCoeff() * extent.maxCoeff();
  parallelRanges(near.size(), 4096, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Index from = std::max<Eigen::Index>(0, near[i] - kDetection.points.along_curve),
                         to = std::min<Eigen::Index>(last, near[i] + kDetection.points.along_curve);
      const Eigen::Vector3f x = all.col(static_cast<Eigen::Index>(i));
      float least = std::numeric_limits<float>::infinity();
      for (Eigen::Index k = from; k <= to; ++k) {
        const float sq_distance = (points.col(k) - x).squaredNorm();
        if (sq_distance >= least) continue;
        least = sq_distance;
        near[i] = static_cast<int>(k);
      }
      is_far[i] = least > sq_reach ? 1 : 0;
    }
  });
  std::vector<int> far;
  for (std::size_t i = 0; i < near.size(); ++i)
    if (is_far[i]) far.push_back(static_cast<int>(i));
  if (far.empty()) return near;
  std::vector<int> nearest;
  std::vector<float> sq_distances;
  makeFlannSearch(points)->search(pointsAt(all, far), 1, nearest, sq_distances);
  for (std::size_t i = 0; i < far.size(); ++i) near[static_cast<std::size_t>(far[i])] = nearest[i];
  return near;
}

std::optional<CloudSubset> subsetOf(const PointsRef& points, const DetectionOptions& options) {
  if (static_cast<double>(points.cols()) <= kDetection.points.most_points) return std::nullopt;
  const double most = mostPoints(points, options);
  if (!(static_cast<double>(points.cols()) > most)) return std::nullopt;
  const DistinctPoints distinct(points);
  if (static_cast<double>(distinct.points.cols()) <= most) return std::nullopt;
  std::vector<int> first_of(static_cast<std::size_t>(distinct.points.cols()), -1);
  for (std::size_t i = 0; i < distinct.index_of.size(); ++i)
    if (int& first = first_of[static_cast<std::size_t>(distinct.index_of[i])]; first < 0) first = static_cast<int>(i);
  const SpreadSubset spread = spreadSubset(distinct.points, static_cast<std::size_t>(most), options.seed);
  CloudSubset subset;
  for (const int i : spread.kept) subset.kept.push_back(first_of[static_cast<std::size_t>(i)]);
  for (const int i : distinct.index_of) subset.beside.push_back(spread.beside[static_cast<std::size_t>(i)]);
  subset.points = pointsAt(points, subset.kept);
  return subset;
}

void spreadSupport(Detection& detection, const std::vector<int>& representative_of) {
  const auto spread = [&](SymmetryPlane& plane) {
    std::vector<float> support(representative_of.size());
    for (std::size_t i = 0; i < support.size(); ++i)
      support[i] = plane.point_support[static_cast<std::size_t>(representative_of[i])];
    plane.point_support = std::move(support);
  };
  for (SymmetryPlane& plane : detection.planes) spread(plane);
  if (detection.best) spread(*detection.best);
}

std::vector<int> evenlyDense(const NormalizedCloud& cloud, std::uint64_t seed) {
  const Eigen::Index size = cloud.points.cols();
  const std::vector<int> samples = drawSamples(size, kDetection.points.density_samples, seed);
  if (size <= kDetection.points.most_counted) return allOf(size);
  std::vector<int> unused;
  std::vector<float> sq_distances;
  const Points at = pointsAt(cloud.points, samples);
  cloud.search->search(at, kDetection.points.most_counted, unused, sq_distances);
  std::vector<float> to_neighbor(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    to_neighbor[i] = sq_distances[i * kDetection.points.most_counted + kDetection.points.neighbors];
  const float sq_radius = median(to_neighbor);
  const auto num_samples = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixX4d places(num_samples, 4);
  Eigen::VectorXd logs(num_samples);
  for (Eigen::Index i = 0; i < num_samples; ++i) {
    const auto first = sq_distances.begin() + i * kDetection.points.most_counted;
    places.row(i) << at.col(i).cast<double>().transpose(), 1.0;
    logs[i] = std::log(
        static_cast<double>(std::upper_bound(first, first + kDetection.points.most_counted, sq_radius) - first));
  }
  const Eigen::Vector3d slope = places.colPivHouseholderQr().solve(logs).head<3>();
  std::vector<double> along(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    along[i] = slope.dot(at.col(static_cast<Eigen::Index>(i)).cast<double>());
  std::sort(along.begin(), along.end());
  const auto last = static_cast<double>(along.size() - 1);
  const double low = along[static_cast<std::size_t>(kDetection.points.trimmed * last)],
               high = along[static_cast<std::size_t>((1.0 - kDetection.points.trimmed) * last)];
  const double strength = std::clamp(
      (high - low - kDetection.points.uneven) / (kDetection.points.fully_uneven - kDetection.points.uneven), 0.0, 1.0);
  if (strength == 0.0) return allOf(size);
  RandomStream random(seed);
  std::vector<int> kept;
  for (Eigen::Index i = 0; i < size; ++i) {
    const double above = slope.dot(cloud.points.col(i).cast<double>()) - low;
    if (random.uniform() < std::exp(-strength * above)) kept.push_back(static_cast<int>(i));
  }
  return kept;
}

}  // namespace pcl_symmetry
