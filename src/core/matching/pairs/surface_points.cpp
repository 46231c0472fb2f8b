#include "core/matching/pairs/surface_points.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/base/median.h"
#include "core/geometry/point_samples.h"
#include "core/normals/surface_normals.h"

namespace pcl_symmetry {

namespace {

// Neighbours that give a normal. chosen: normals are compared in steps of 15 degrees; half follows the noise, twice
// blurs edges.
constexpr int kNeighbours = 16;
// Share of the plane that discs about the points cover, of radius half their least distance, where no further point has
// a place. derived: the jamming limit of random sequential adsorption of discs, 0.547; a little less, so that there are
// enough points.
constexpr double kCovered = 0.5;

/// Points of the surface that are at least \p distance apart, in random order.
std::vector<int> spreadPoints(const Points& points, double distance, int most, std::uint64_t seed) {
  const auto sq_distance = static_cast<float>(distance * distance);
  std::vector<int> chosen;
  for (const int i : drawSamples(points.cols(), static_cast<int>(points.cols()) - 1, seed)) {
    bool near = false;
    for (const int j : chosen)
      if ((points.col(i) - points.col(j)).squaredNorm() < sq_distance) {
        near = true;
        break;
      }
    if (!near) chosen.push_back(i);
    if (static_cast<int>(chosen.size()) == most) break;
  }
  return chosen;
}

}  // namespace

std::vector<SurfacePoints> evenSurfacePoints(const Points& points, const std::vector<int>& counts, std::uint64_t seed,
                                             int num_threads) {
  const ClosestPointSearch::Ptr search = makeTreeSearch(points);
  const LocalGeometry geometry = localGeometry(points, *search, kNeighbours, num_threads);
  double area = 0.0;
  for (const float spacing : geometry.spacing) area += static_cast<double>(spacing) * spacing;
  std::vector<SurfacePoints> found;
  for (const int count : counts) {
    std::vector<int> chosen = allOf(points.cols());
    // Discs of half the distance cover that share of the area.
    if (points.cols() > count)
      chosen = spreadPoints(points, std::sqrt(4.0 * kCovered * area / (std::acos(-1.0) * count)), count, seed);
    found.push_back({pointsAt(points, chosen), pointsAt(geometry.normals, chosen)});
  }
  return found;
}

SurfacePoints evenSurfacePoints(const Points& points, int count, std::uint64_t seed, int num_threads) {
  return std::move(evenSurfacePoints(points, std::vector<int>{count}, seed, num_threads).front());
}

}  // namespace pcl_symmetry
