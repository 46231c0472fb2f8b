#include "core/registration/posed_surface.h"

#include <numeric>
#include <utility>

#include "core/base/median.h"
#include "core/base/random.h"
#include "core/normals/surface_normals.h"

namespace pcl_symmetry {

namespace {

// Share of the spacing; rougher surfaces take normals from more neighbours. chosen: half blurs the edges of clean
// scans, twice leaves noisy scans with random normals.
constexpr double kRoughShare = 0.15;
// Neighbours on rough surfaces. chosen: four times as many halve the error of the normals; half is noisier, twice blurs
// edges.
constexpr int kNumRoughNeighbours = 32;

std::vector<int> randomOrder(int size, std::uint64_t seed) {
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  RandomStream random(seed);
  for (int i = size - 1; i > 0; --i) std::swap(order[i], order[random.below(static_cast<std::uint64_t>(i) + 1)]);
  return order;
}

}  // namespace

PosedSurface::PosedSurface(const PointsRef& input, std::optional<Visibility> seen_space, std::uint64_t seed,
                           int num_threads)
    : points(input),
      order(randomOrder(static_cast<int>(input.cols()), seed)),
      seen(std::move(seen_space)),
      grid(input),
      search(makeTreeSearch(input)) {
  LocalGeometry geometry = localGeometry(points, *search, kNumSupportNeighbours, num_threads);
  const double typical = median(geometry.spacing);
  spacing = geometry.spacing;
  if (median(geometry.roughness) > kRoughShare * typical)
    geometry = localGeometry(points, *search, kNumRoughNeighbours, num_threads);
  normals = std::move(geometry.normals);
  accuracy = typical + 2.0 * median(std::move(geometry.roughness));
}

}  // namespace pcl_symmetry
