#include "pcl_symmetry/core/local_maxima.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

/// Whether no neighbor is higher; of equal neighbors, the one with the lowest index is the maximum.
bool isLocalMaximum(const SymmetryMap& map, std::size_t index) {
  const float value = map[index];
  return map.grid.visitNeighbors(map.grid.bin(index), [&](std::size_t neighbor) {
    return map[neighbor] < value || (map[neighbor] == value && neighbor > index);
  });
}

/// Marks the bins of one direction that are above 0 and not below a bin beside them: most bins fail at one of the
/// neighbors that need no step across a seam.
/// \param beside the same offsets in the directions one step away; \p row itself where there is none.
/// \param[out] marks size of them.
PCL_SYMMETRY_MULTIVERSION
void markHighBins(const float* row, const float* const* beside, int size, std::uint8_t* marks) {
  const float *const a = beside[0], *const b = beside[1], *const c = beside[2], *const d = beside[3];
  for (int k = 0; k < size; ++k) {
    const float value = row[k], highest = std::max(std::max(a[k], b[k]), std::max(c[k], d[k]));
    marks[k] = static_cast<std::uint8_t>((value > 0.0f) & (highest <= value));
  }
  for (int k = 1; k < size; ++k) marks[k] &= static_cast<std::uint8_t>(row[k - 1] <= row[k]);
  for (int k = 0; k + 1 < size; ++k) marks[k] &= static_cast<std::uint8_t>(row[k + 1] <= row[k]);
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
  checkNumThreads(num_threads);
  check(laplacian >= 0.0 && laplacian <= 1.0, "laplacian", laplacian, "in [0, 1]");
}

std::vector<LocalMaximum> findLocalMaxima(const SymmetryMap& map, const LocalMaximaOptions& options) {
  options.validate();
  std::vector<LocalMaximum> maxima;
  if (map.empty()) return maxima;
  const std::size_t strongest = map.strongest();
  const double strength = options.strength * map[strongest];
  const double curvature = options.laplacian * -laplacian(map, map.grid.bin(strongest));
  const PlaneGrid& grid = map.grid;
  std::vector<std::vector<LocalMaximum>> rows(grid.numTheta());
  parallelBlocks(rows.size(), options.num_threads, [&](std::size_t row) {
    const int t = static_cast<int>(row);
    const std::size_t next_phi = grid.numRadius(), next_theta = next_phi * grid.numPhi();
    std::vector<std::uint8_t> marks(next_phi);
    for (int p = 0; p < grid.numPhi(); ++p) {
      const float* const values = &map.values[grid.index({t, p, 0})];
      const float* const beside[] = {
          p > 0 ? values - next_phi : values, p + 1 < grid.numPhi() ? values + next_phi : values,
          t > 0 ? values - next_theta : values, t + 1 < grid.numTheta() ? values + next_theta : values};
      markHighBins(values, beside, grid.numRadius(), marks.data());
      if (std::find(marks.begin(), marks.end(), 1) == marks.end()) continue;
      const double center_offset = grid.normal(t, p).dot(map.center_of_mass - grid.center());
      for (int k = 0; k < grid.numRadius(); ++k) {
        if (!marks[k]) continue;
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
