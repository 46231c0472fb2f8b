#include "pcl_symmetry/core/local_maxima.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/parallel.h"

namespace pcl_symmetry {

namespace {

/// Whether no neighbor is higher; of equal neighbors, the one with the lowest index is the maximum.
bool isLocalMaximum(const SymmetryMap& map, std::size_t index) {
  const float value = map[index];
  return map.grid.visitNeighbors(map.grid.bin(index), [&](std::size_t neighbor) {
    return map[neighbor] < value || (map[neighbor] == value && neighbor > index);
  });
}

/// Sum of the second differences. Planes beyond the ends of r have D = 0.
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

std::vector<LocalMaximum> findLocalMaxima(const SymmetryMap& map, const LocalMaximaOptions& options, int num_threads) {
  options.validate();
  checkNumThreads(num_threads);
  std::vector<LocalMaximum> maxima;
  if (map.empty()) return maxima;
  const std::size_t strongest = map.strongest();
  const double strength = options.strength * map[strongest];
  const double curvature = options.laplacian * -laplacian(map, map.grid.bin(strongest));
  const PlaneGrid& grid = map.grid;
  std::vector<std::vector<LocalMaximum>> rows(grid.numTheta());
  parallelBlocks(rows.size(), num_threads, [&](std::size_t row) {
    const int t = static_cast<int>(row);
    for (int p = 0; p < grid.numPhi(); ++p) {
      const float* const values = &map.values[grid.index({t, p, 0})];
      const double center_offset = grid.normal(t, p).dot(map.center_of_mass - grid.center());
      for (int k = 0; k < grid.numRadius(); ++k) {
        // Most bins fail at those beside them along r.
        const float beside = std::max(k > 0 ? values[k - 1] : 0.0f, k + 1 < grid.numRadius() ? values[k + 1] : 0.0f);
        if (values[k] <= 0.0f || values[k] < beside) continue;
        const PlaneGrid::Bin bin{t, p, k};
        const double share = 1.0 - std::abs(grid.offset(k) - center_offset) / grid.radius();
        if (values[k] < strength * share) continue;
        if (!isLocalMaximum(map, grid.index(bin)) || -laplacian(map, bin) < curvature) continue;
        rows[row].push_back({bin, grid.plane(bin), values[k]});
      }
    }
  });
  for (const auto& row : rows) maxima.insert(maxima.end(), row.begin(), row.end());
  std::stable_sort(maxima.begin(), maxima.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
  return maxima;
}

}  // namespace pcl_symmetry
