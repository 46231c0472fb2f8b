#include "core/evidence/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/parallel.h"
#include "core/evidence/evidence_rules.h"
#include "core/geometry/point_samples.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

SurfaceSamples::SurfaceSamples(const Points& points, const LocalGeometry& geometry, int num_threads)
    : samples_(static_cast<std::size_t>(points.cols())) {
  parallelRanges(samples_.size(), 2048, num_threads, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i) {
      const float spacing = geometry.spacing[i], rough = geometry.roughness[i] / std::max(spacing, 1e-6f);
      samples_[static_cast<std::size_t>(i)] = {
          points.col(i),
          geometry.normals.col(i),
          kEvidence.disc_radius * spacing,
          geometry.roughness[i],
          std::clamp((kEvidence.max_roughness - rough) / kEvidence.trust_width, 0.0f, 1.0f),
          geometry.nearest[i]};
    }
  });
}

namespace {

/// Squared distance of a point from the disc of a sample.
float sqDistanceFromDisc(const SurfaceSample& sample, const Eigen::Vector3f& point, float across_factor) {
  const Eigen::Vector3f difference = point - sample.point;
  const float across = sample.normal.dot(difference);
  const float along = std::sqrt(std::max(0.0f, difference.squaredNorm() - across * across));
  const float beside = std::max(0.0f, along - sample.disc_radius);
  return across_factor * across_factor * across * across + beside * beside;
}

/// Distance from the nearest of the discs of a sample and its neighbors, but not from that of \p self (-1: none).
float distanceNear(int closest, int self, const Eigen::Vector3f& point, const SurfaceSamples& samples,
                   float across_factor) {
  float least = sqDistanceFromDisc(samples[closest], point, across_factor);
  for (const int j : samples[closest].nearest)
    if (j != self) least = std::min(least, sqDistanceFromDisc(samples[j], point, across_factor));
  return std::sqrt(least);
}

}  // namespace

std::vector<float> surfaceDistances(const Points& points, const std::vector<int>& closest,
                                    const SurfaceSamples& samples) {
  std::vector<float> distances(closest.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < closest.size(); ++i)
    if (closest[i] >= 0) distances[i] = distanceNear(closest[i], -1, points.col(i), samples, 1.0f);
  return distances;
}

std::vector<float> ownSurfaceDistances(const SurfaceSamples& samples, int num_threads) {
  std::vector<float> distances(static_cast<std::size_t>(samples.size()));
  parallelRanges(distances.size(), 2048, num_threads, [&](std::size_t begin, std::size_t end) {
    for (auto i = static_cast<int>(begin); i < static_cast<int>(end); ++i)
      distances[i] = distanceNear(samples[i].nearest[0], i, samples[i].point, samples, kEvidence.new_point_factor);
  });
  return distances;
}

double shareWithin(const std::vector<float>& distances, double tolerance) {
  const auto limit = static_cast<float>(tolerance);
  const auto count =
      std::count_if(distances.begin(), distances.end(), [&](float distance) { return distance <= limit; });
  return static_cast<double>(count) / static_cast<double>(distances.size());
}

namespace {

/// Quarters that make up one half and the other. The three ways to do so.
constexpr std::array<std::array<int, 4>, 3> kPairings{{{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}}};

/// Two halves of points, drawn at random.
std::pair<Points, Points> halvesOf(const Points& points, std::uint64_t seed) {
  const Eigen::Index size = points.cols();
  std::vector<int> second = drawSamples(size, static_cast<int>(size / 2), seed), first;
  std::sort(second.begin(), second.end());
  const std::vector<int> all = allOf(size);
  std::set_difference(all.begin(), all.end(), second.begin(), second.end(), std::back_inserter(first));
  return {pointsAt(points, first), pointsAt(points, second)};
}

Points joined(const Points& a, const Points& b) {
  Points all(3, a.cols() + b.cols());
  all << a, b;
  return all;
}

/// \return what the correlation of two distance transforms lacks of 1, in [0, 1].
double lost(const GaussianEdt& a, const GaussianEdt& b) {
  const double product = std::inner_product(a.values().begin(), a.values().end(), b.values().begin(), 0.0);
  return 1.0 - std::clamp(product / std::sqrt(a.sqNorm() * b.sqNorm()), 0.0, 1.0);
}

}  // namespace

SplitSurface::SplitSurface(const Points& points, std::uint64_t seed, int num_threads) : seed_(seed) {
  std::tie(first_, second_) = halvesOf(points, seed);
  search_ = makeFlannSearch(second_);
  samples_.emplace(second_, localGeometry(second_, *search_, kNumSupportNeighbors, num_threads));
}

std::vector<float> SplitSurface::reflectedDistances(const ReflectionPlane& plane) const {
  return distances(reflectedPoints(first_, plane));
}

double SplitSurface::ownScore(int num_cells, double sigma, const BoundingBall& ball, int num_threads) const {
  GaussianEdtOptions options;
  options.num_cells = num_cells;
  options.sigma = sigma;
  options.center = ball.center;
  options.radius = ball.radius;
  options.num_threads = num_threads;
  const auto edt = [&](const Points& points) { return GaussianEdt(points, options); };
  // Quarters are drawn anew: points that follow each other in a file may lie beside each other.
  const auto [a1, a2] = halvesOf(first_, seed_);
  const auto [b1, b2] = halvesOf(second_, seed_);
  const std::array<Points, 4> quarters{a1, a2, b1, b2};
  const std::array<GaussianEdt, 4> edts{edt(quarters[0]), edt(quarters[1]), edt(quarters[2]), edt(quarters[3])};
  double lost_of_quarters = 0.0, lost_of_halves = 0.0;
  for (const auto& [a, b, c, d] : kPairings) {
    lost_of_quarters += lost(edts[a], edts[b]) + lost(edts[c], edts[d]);
    lost_of_halves += lost(edt(joined(quarters[a], quarters[b])), edt(joined(quarters[c], quarters[d])));
  }
  lost_of_quarters *= 0.5;
  const double factor = lost_of_quarters > 0.0 ? std::min(1.0, lost_of_halves / lost_of_quarters) : 0.0;
  return std::max(0.5, 1.0 - lost_of_halves / static_cast<double>(kPairings.size()) * factor);
}

std::vector<float> SplitSurface::distances(const Points& points) const {
  std::vector<int> closest;
  std::vector<float> sq_distances;
  search_->search(points, 1, closest, sq_distances);
  return surfaceDistances(points, closest, *samples_);
}

}  // namespace pcl_symmetry
