#include "pcl_symmetry/core/point_symmetry.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pcl_symmetry/core/parallel.h"
#include "simd.h"

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

/// Directions with their values, the largest first: those that can no longer raise anything are left out at the end.
struct DirectionRows {
  float shift, scale, last;  // as raise() wants them
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> greatest;
  std::vector<std::vector<float>> rows;

  /// \param normal of each direction, by its index in the values.
  template <typename Normal>
  DirectionRows(const std::vector<float>& values, std::size_t num_directions, int num_radius, double radius,
                const Normal& normal)
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
};

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

}  // namespace

std::vector<float> pointSymmetry(const SymmetryMap& map, const PointsRef& points, int num_threads) {
  if (map.empty()) return std::vector<float>(points.cols(), 0.0f);
  const PlaneGrid& grid = map.grid;
  const DirectionRows directions(
      map.values, grid.numDirections(), grid.numRadius(), grid.radius(), [&](std::size_t d) -> Eigen::Vector3f {
        return grid.normal(static_cast<int>(d / grid.numPhi()), static_cast<int>(d % grid.numPhi())).cast<float>();
      });
  return greatestThrough(directions, normalizePoints(points, grid.center(), 1.0), num_threads);
}

std::vector<float> pointSymmetry(const LineMap& map, const Points2D& points, int num_threads) {
  if (map.empty()) return std::vector<float>(points.cols(), 0.0f);
  const LineGrid& grid = map.grid;
  const DirectionRows directions(map.values, grid.numTheta(), grid.numRadius(), grid.radius(), [&](std::size_t t) {
    const double theta = grid.theta(static_cast<int>(t));
    return Eigen::Vector3d(std::cos(theta), std::sin(theta), 0.0).cast<float>().eval();
  });
  Points embedded = Points::Zero(3, points.cols());
  embedded.topRows<2>() = (points.cast<double>().colwise() - grid.center()).cast<float>();
  return greatestThrough(directions, embedded, num_threads);
}

}  // namespace pcl_symmetry
