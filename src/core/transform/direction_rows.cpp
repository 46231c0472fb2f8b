#include "core/transform/direction_rows.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t kBlock = 1024;  // points that go through the directions together

/// best[i] = max(best[i], value of the row at n . x_i), linear between its entries.
/// \param row at 0 and beyond \p last 0. \param shift,scale place in the row = n . x * scale + shift.
PCL_SYMMETRY_MULTIVERSION
void raise(const float* x, const float* y, const float* z, int size, const float* normal, float shift, float scale,
           const float* row, float last, float* best) {
  const float nx = normal[0] * scale, ny = normal[1] * scale, nz = normal[2] * scale;
  for (int i = 0; i < size; ++i) {
    const float at = std::min(std::max(nx * x[i] + ny * y[i] + nz * z[i] + shift, 0.0f), last);
    const int k = static_cast<int>(at);
    const float value = row[k] + (at - static_cast<float>(k)) * (row[k + 1] - row[k]);
    best[i] = value > best[i] ? value : best[i];
  }
}

/// D along one direction at the bins, and half-way between by the cubic through four: a peak between two bins, such as
/// that of a plane through the center of the grid, would be cut off otherwise.
/// \return 2 num_radius + 4 values: two of 0, bin 0, half-way, bin 1 ..., the last bin, and three of 0.
std::vector<float> refinedRow(const float* values, int num_radius) {
  const auto at = [&](int k) { return k < 0 || k >= num_radius ? 0.0f : values[k]; };
  std::vector<float> row(2 * num_radius + 4, 0.0f);
  for (int k = 0; k < num_radius; ++k) row[2 * k + 2] = values[k];
  for (int k = 0; k + 1 < num_radius; ++k)
    row[2 * k + 3] = std::max(0.0f, (9.0f * (at(k) + at(k + 1)) - at(k - 1) - at(k + 2)) / 16.0f);
  return row;
}

}  // namespace

DirectionRows::DirectionRows(const std::vector<float>& values, std::size_t num_directions, int num_radius,
                             double radius, const std::function<Eigen::Vector3f(std::size_t)>& normal)
    : shift(static_cast<float>(num_radius + 1)),
      scale(static_cast<float>(num_radius / radius)),
      last(static_cast<float>(2 * num_radius + 2)) {
  for (std::size_t d = 0; d < num_directions; ++d) rows.push_back(refinedRow(&values[d * num_radius], num_radius));
  std::vector<float> maxima;
  for (const auto& row : rows) maxima.push_back(*std::max_element(row.begin(), row.end()));
  std::vector<std::size_t> order(num_directions);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return maxima[a] > maxima[b]; });
  std::vector<std::vector<float>> sorted;
  for (const std::size_t d : order) {
    normals.push_back(normal(d));
    greatest.push_back(maxima[d]);
    sorted.push_back(std::move(rows[d]));
  }
  rows = std::move(sorted);
}

/// \param points 3 x N relative to the center of the grid.
std::vector<float> greatestThrough(const DirectionRows& directions, const Points& points, int num_threads) {
  std::vector<float> best(points.cols(), 0.0f);
  parallelRanges(points.cols(), kBlock, num_threads, [&](std::size_t begin, std::size_t end) {
    const int size = static_cast<int>(end - begin);
    const Eigen::MatrixX3f block = points.middleCols(begin, size).transpose();
    for (std::size_t d = 0; d < directions.rows.size(); ++d) {
      if (d % 32 == 0 && directions.greatest[d] <= *std::min_element(best.begin() + begin, best.begin() + end)) break;
      raise(block.col(0).data(), block.col(1).data(), block.col(2).data(), size, directions.normals[d].data(),
            directions.shift, directions.scale, directions.rows[d].data(), directions.last, best.data() + begin);
    }
  });
  return best;
}

}  // namespace pcl_symmetry
