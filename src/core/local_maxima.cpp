#include "pcl_symmetry/core/local_maxima.h"

#include <algorithm>
#include <cmath>

#include "check.h"

namespace pcl_symmetry {

namespace {

bool isLocalMaximum(const SymmetryMap& map, std::size_t index) {
  const float value = map[index];
  for (const std::size_t neighbour : map.grid.neighbours(map.grid.bin(index))) {
    if (map[neighbour] > value || (map[neighbour] == value && neighbour < index)) return false;
  }
  return true;
}

/// Sum of the second differences; planes beyond the ends of r have no symmetry.
double laplacian(const SymmetryMap& map, const PlaneGrid::Bin& bin) {
  const auto value = [&](int dt, int dp, int dk) {
    const auto at = map.grid.step(bin, dt, dp, dk);
    return at ? static_cast<double>(map[map.grid.index(*at)]) : 0.0;
  };
  return value(-1, 0, 0) + value(1, 0, 0) + value(0, -1, 0) + value(0, 1, 0) + value(0, 0, -1) + value(0, 0, 1) -
         6.0 * value(0, 0, 0);
}

}  // namespace

void LocalMaximaOptions::validate() const {
  check(strength >= 0.0 && strength <= 1.0, "strength", strength, "in [0, 1]");
  check(laplacian >= 0.0 && laplacian <= 1.0, "laplacian", laplacian, "in [0, 1]");
}

std::vector<LocalMaximum> findLocalMaxima(const SymmetryMap& map, const LocalMaximaOptions& options) {
  options.validate();
  std::vector<LocalMaximum> maxima;
  if (map.empty()) return maxima;
  const std::size_t strongest = map.strongest();
  const double strength = options.strength * map[strongest];
  const double curvature = options.laplacian * -laplacian(map, map.grid.bin(strongest));
  for (std::size_t index = 0; index < map.values.size(); ++index) {
    if (map[index] <= 0.0f) continue;
    const auto bin = map.grid.bin(index);
    // Cheap test first: along r the neighbours lie side by side.
    if (bin.radius > 0 && map[index - 1] > map[index]) continue;
    if (bin.radius + 1 < map.grid.numRadius() && map[index + 1] > map[index]) continue;
    const ReflectionPlane plane = map.grid.plane(bin);
    const double share = 1.0 - std::abs(plane.signedDistance(map.center_of_mass)) / map.grid.radius();
    if (map[index] < strength * share || !isLocalMaximum(map, index) || -laplacian(map, bin) < curvature) continue;
    maxima.push_back({bin, plane, map[index]});
  }
  std::stable_sort(maxima.begin(), maxima.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
  return maxima;
}

}  // namespace pcl_symmetry
