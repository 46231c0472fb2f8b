#include "core/transform/direction_rows.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t points_together = 1024;  // they stay in the first cache
constexpr std::size_t stop_every = 32;         // directions between two looks at the smallest value

/// Coordinates of points, each in an array of its own.
struct PointBlock {
  const float *x, *y, *z;
  int size;
};

/// best[i] = max(best[i], value of the row at point i), linear between its entries.
PCL_SYMMETRY_MULTIVERSION
void raise(const PointBlock& points, const DirectionRows::Row& direction, const DirectionRows::Place& place,
           float* best) {
  const float shift = place.shift, scale = place.scale, last = place.last;
  const float nx = direction.normal[0] * scale, ny = direction.normal[1] * scale, nz = direction.normal[2] * scale;
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

}  // namespace

DirectionRows::DirectionRows(const std::vector<float>& values, const std::vector<Eigen::Vector3f>& normals,
                             int num_radius, double radius)
    : place_{static_cast<float>(num_radius + 1), static_cast<float>(num_radius / radius),
             static_cast<float>(2 * num_radius + 2)} {
  for (std::size_t d = 0; d < normals.size(); ++d) {
    std::vector<float> row = refinedRow(&values[d * num_radius], num_radius);
    const float greatest = *std::max_element(row.begin(), row.end());
    rows_.push_back({normals[d], greatest, std::move(row)});
  }
  std::stable_sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.greatest > b.greatest; });
}

std::vector<float> DirectionRows::greatestThrough(const Points& points, int num_threads) const {
  std::vector<float> best(points.cols(), 0.0f);
  parallelRanges(points.cols(), points_together, num_threads, [&](std::size_t begin, std::size_t end) {
    const int size = static_cast<int>(end - begin);
    const Eigen::MatrixX3f block = points.middleCols(begin, size).transpose();
    const PointBlock coordinates{block.col(0).data(), block.col(1).data(), block.col(2).data(), size};
    for (std::size_t d = 0; d < rows_.size(); ++d) {
      // The directions left can no longer raise anything.
      if (d % stop_every == 0 && rows_[d].greatest <= *std::min_element(best.begin() + begin, best.begin() + end))
        break;
      raise(coordinates, rows_[d], place_, best.data() + begin);
    }
  });
  return best;
}

}  // namespace pcl_symmetry
