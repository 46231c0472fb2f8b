/// The map back from planes to points (Figure 1).
#include <algorithm>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t stop_every = 32;  // directions between two looks at the smallest value

/// Coordinates of points, each in an array of its own.
struct PointBlock {
  const float *x, *y, *z;
  int size;
};

/// A direction and its values: the middle of the row is at the center of the grid, its ends are 0.
struct DirectionRow {
  Eigen::Vector3f normal;  ///< of length one step of the row
  float greatest;
  std::vector<float> values;
};

/// best[i] = max(best[i], value of the row at point i), linear between its entries.
PCL_SYMMETRY_MULTIVERSION
void raise(const PointBlock& points, const DirectionRow& direction, float* best) {
  const float last = static_cast<float>(direction.values.size() - 2), shift = 0.5f * last;
  const float nx = direction.normal[0], ny = direction.normal[1], nz = direction.normal[2];
  const float *const x = points.x, *const y = points.y, *const z = points.z, *const row = direction.values.data();
  const int size = points.size;
  for (int i = 0; i < size; ++i) {
    const float at = std::min(std::max(nx * x[i] + ny * y[i] + nz * z[i] + shift, 0.0f), last);
    const int k = static_cast<int>(at);
    const float value = row[k] + (at - static_cast<float>(k)) * (row[k + 1] - row[k]);
    best[i] = value > best[i] ? value : best[i];
  }
}

/// D along one direction at the bins, and half-way between them by the cubic through four. Without these a peak between
/// two bins would be cut off, for example the one at the center of the grid.
/// \return 2 num_radius + 4 values: two of 0, bin 0, half-way, bin 1, ..., the last bin, and three of 0.
std::vector<float> refinedRow(const float* values, int num_radius) {
  const auto at = [&](int k) { return k < 0 || k >= num_radius ? 0.0f : values[k]; };
  std::vector<float> row(2 * num_radius + 4, 0.0f);
  for (int k = 0; k < num_radius; ++k) row[2 * k + 2] = values[k];
  for (int k = 0; k + 1 < num_radius; ++k)
    row[2 * k + 3] = std::max(0.0f, (9.0f * (at(k) + at(k + 1)) - at(k - 1) - at(k + 2)) / 16.0f);
  return row;
}

/// \param values rows of num_radius values of D, one for each direction.
/// \param normals unit vectors, one for each direction.
/// \param radius of the grid, input units: r is in [-radius, radius].
/// \param points 3 x N, relative to the center of the grid, input units.
/// \return the greatest value of any direction through each point, at least 0.
std::vector<float> greatestThrough(const std::vector<float>& values, const std::vector<Eigen::Vector3f>& normals,
                                   int num_radius, double radius, const Points& points, int num_threads) {
  const float steps_per_unit = static_cast<float>(num_radius / radius);
  std::vector<DirectionRow> rows;
  for (std::size_t d = 0; d < normals.size(); ++d) {
    std::vector<float> row = refinedRow(&values[d * num_radius], num_radius);
    const float greatest = *std::max_element(row.begin(), row.end());
    rows.push_back({normals[d] * steps_per_unit, greatest, std::move(row)});
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const DirectionRow& a, const DirectionRow& b) { return a.greatest > b.greatest; });
  std::vector<float> best(points.cols(), 0.0f);
  parallelPoints(points.cols(), num_threads, [&](std::size_t begin, std::size_t end) {
    const int size = static_cast<int>(end - begin);
    const Eigen::MatrixX3f block = points.middleCols(begin, size).transpose();
    const PointBlock coordinates{block.col(0).data(), block.col(1).data(), block.col(2).data(), size};
    for (std::size_t d = 0; d < rows.size(); ++d) {
      // The directions left can no longer raise anything.
      if (d % stop_every == 0 && rows[d].greatest <= *std::min_element(best.begin() + begin, best.begin() + end)) break;
      raise(coordinates, rows[d], best.data() + begin);
    }
  });
  return best;
}

}  // namespace

std::vector<float> pointSymmetry(const SymmetryMap& map, const PointsRef& points, int num_threads) {
  if (map.empty()) return std::vector<float>(points.cols(), 0.0f);
  const PlaneGrid& grid = map.grid;
  std::vector<Eigen::Vector3f> normals;
  for (std::size_t d = 0; d < grid.numDirections(); ++d) normals.push_back(grid.normal(d).cast<float>());
  return greatestThrough(map.values, normals, grid.numRadius(), grid.radius(),
                         normalizePoints(points, grid.center(), 1.0), num_threads);
}

}  // namespace pcl_symmetry
