#include "core/evidence/split_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/geometry/point_samples.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

/// The three ways to combine quarters into two halves.
constexpr std::array<std::array<int, 4>, 3> kPairings{{{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}}};

/// Two halves of points, drawn at random.
std::pair<Points, Points> halvesOf(const Points& points, std::uint64_t seed) {
  const Eigen::Index size = points.cols();
  std::vector<int> second = drawSamples(size, static_cast<int>(size / 2), seed), first;
  std::sort(second.begin(), second.end());
  const std::vector<int> all = allIndices(size);
  std::set_difference(all.begin(), all.end(), second.begin(), second.end(), std::back_inserter(first));
  return {pointsAt(points, first), pointsAt(points, second)};
}

Points joined(const Points& a, const Points& b) {
  Points all(3, a.cols() + b.cols());
  all << a, b;
  return all;
}

/// \return 1 minus the correlation of two distance transforms, in [0, 1].
double lost(const GaussianEdt& a, const GaussianEdt& b) {
  const double product = std::inner_product(a.values().begin(), a.values().end(), b.values().begin(), 0.0);
  return 1.0 - std::clamp(product / std::sqrt(a.sqNorm() * b.sqNorm()), 0.0, 1.0);
}

}  // namespace

SplitSurface::SplitSurface(const Points& points, std::uint64_t seed, int num_threads) : seed_(seed) {
  std::tie(first_, second_) = halvesOf(points, seed);
  search_ = makeFlannSearch(second_);
  samples_ = surfaceSamples(second_, localGeometry(second_, *search_, num_threads));
}

std::vector<float> SplitSurface::reflectedDistances(const ReflectionPlane& plane) const {
  return distances(reflectedPoints(first_, plane));
}

double SplitSurface::ownScore(int num_cells, double sigma, const BoundingBall& ball, int num_threads) const {
  const auto edt = [&](const Points& points) {
    return GaussianEdt(points, {num_cells, sigma, num_threads, ball.radius, ball.center});
  };
  // Quarters are drawn anew, because successive points of a file may be neighbors.
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
  return surfaceDistances(points, search_->closest(points), samples_);
}

}  // namespace pcl_symmetry
