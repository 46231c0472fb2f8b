#include "core/matching/surface_points.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "core/matching/matching_rules.h"

namespace pcl_symmetry {

namespace {

/// Points of the surface that are at least \p distance apart.
/// \param order order in which points are tried.
std::vector<int> spreadPoints(const Points& points, const std::vector<int>& order, double distance, int max_count) {
  const auto sq_least = static_cast<float>(distance * distance);
  std::vector<int> chosen;
  for (const int i : order) {
    const Eigen::Vector3f x = points.col(i);
    const bool is_near = std::any_of(chosen.begin(), chosen.end(), [&](int j) {
      const Eigen::Vector3f d = x - points.col(j);
      return d.x() * d.x() + d.y() * d.y() + d.z() * d.z() < sq_least;
    });
    if (!is_near) chosen.push_back(i);
    if (static_cast<int>(chosen.size()) == max_count) break;
  }
  return chosen;
}

/// Area of the surface, from the spacing of some of its points.
double areaOf(const Points& points, const ClosestPointSearch& search, std::vector<int> order) {
  order.resize(std::min<std::size_t>(order.size(), 1000));
  double sum = 0.0;
  for (const float spacing : localGeometryAt(points, search, pointsAt(points, order), kMatching.num_neighbors).spacing)
    sum += static_cast<double>(spacing) * spacing;
  return sum / static_cast<double>(order.size()) * static_cast<double>(points.cols());
}

}  // namespace

std::vector<SurfacePoints> evenSurfacePoints(const Points& points, const std::vector<int>& counts, std::uint64_t seed) {
  const ClosestPointSearch::Ptr search = makeFlannSearch(points);
  const std::vector<int> order = shuffled(points.cols(), seed);
  const double area = areaOf(points, *search, order);
  std::vector<SurfacePoints> found;
  for (const int count : counts) {
    std::vector<int> chosen = allIndices(points.cols());
    // Discs of half the distance cover at most 0.547 of the area, the jamming limit of random sequential adsorption.
    if (points.cols() > count) chosen = spreadPoints(points, order, std::sqrt(4.0 * 0.5 * area / (kPi * count)), count);
    const Points kept = pointsAt(points, chosen);
    found.push_back({kept, localGeometryAt(points, *search, kept, kMatching.num_neighbors).normals});
  }
  return found;
}

SurfacePoints evenSurfacePoints(const Points& points, int count, std::uint64_t seed) {
  return std::move(evenSurfacePoints(points, std::vector<int>{count}, seed).front());
}

}  // namespace pcl_symmetry
