#include "core/detection/even_density.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/base/median.h"
#include "core/base/random.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

constexpr int kDensitySamples = 1000;  // chosen: the slope has an error of 2 % at an even density; more cost time
// Neighbours that are counted, and that a neighbourhood has in the middle. chosen: counts of 16 vary by a quarter; at
// half, the slope is noisy, at twice, neighbourhoods are as large as parts of the shape.
constexpr int kMostCounted = 48, kNeighbours = 16;
// Ends of the range, shares of the points. chosen: beyond, few points are extrapolated to.
constexpr double kEnd = 0.05;
// Logarithm of the ratio of the densities at the ends from which, and by which more, they are made even. chosen: shapes
// themselves vary by less; a density of a quarter has 1.1.
constexpr double kUneven = 0.4, kFullyUneven = 0.7;

}  // namespace

std::vector<int> evenlyDense(const NormalizedCloud& cloud, std::uint64_t seed) {
  const Eigen::Index size = cloud.points.cols();
  const std::vector<int> samples = drawSamples(size, kDensitySamples, seed);
  if (size <= kMostCounted) return allOf(size);
  std::vector<int> unused;
  std::vector<float> sq_distances;
  const Points at = pointsAt(cloud.points, samples);
  cloud.search->search(at, kMostCounted, unused, sq_distances);
  std::vector<float> to_neighbour(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) to_neighbour[i] = sq_distances[i * kMostCounted + kNeighbours];
  const float sq_radius = median(to_neighbour);
  const auto num_samples = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixX4d places(num_samples, 4);
  Eigen::VectorXd logs(num_samples);
  for (Eigen::Index i = 0; i < num_samples; ++i) {
    const auto first = sq_distances.begin() + i * kMostCounted;
    places.row(i) << at.col(i).cast<double>().transpose(), 1.0;
    logs[i] = std::log(static_cast<double>(std::upper_bound(first, first + kMostCounted, sq_radius) - first));
  }
  const Eigen::Vector3d slope = places.colPivHouseholderQr().solve(logs).head<3>();
  std::vector<double> along(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    along[i] = slope.dot(at.col(static_cast<Eigen::Index>(i)).cast<double>());
  std::sort(along.begin(), along.end());
  const auto last = static_cast<double>(along.size() - 1);
  const double low = along[static_cast<std::size_t>(kEnd * last)],
               high = along[static_cast<std::size_t>((1.0 - kEnd) * last)];
  const double strength = std::clamp((high - low - kUneven) / (kFullyUneven - kUneven), 0.0, 1.0);
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
