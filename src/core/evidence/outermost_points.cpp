#include "core/evidence/outermost_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pcl_symmetry {

namespace {

// Points for each square of the side of a box. chosen: 10 000 points of a surface lie in some 200 cells of 50, so that
// a question looks at about as many boxes as points; other numbers were not tried.
constexpr double kPointsPerSquare = 160.0;

/// The cell of each point, in a box that has as many cells along each side.
std::vector<int> cellsOf(const Points& points, int cells_per_side) {
  const Eigen::Vector3f least = points.rowwise().minCoeff(), extent = points.rowwise().maxCoeff() - least;
  const auto sides = static_cast<float>(cells_per_side);
  const Eigen::Vector3f per_unit = (extent.array() > 0.0f).select(sides / extent.array(), 0.0f);
  std::vector<int> cells(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3f place = (points.col(i) - least).cwiseProduct(per_unit);
    int cell = 0;
    for (int k = 0; k < 3; ++k)
      cell = cell * cells_per_side + std::clamp(static_cast<int>(place[k]), 0, cells_per_side - 1);
    cells[static_cast<std::size_t>(i)] = cell;
  }
  return cells;
}

}  // namespace

OutermostPoints::OutermostPoints(const Points& points) : mean_(points.rowwise().mean()) {
  const auto size = static_cast<std::size_t>(points.cols());
  const int cells_per_side = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(size) / kPointsPerSquare)));
  const std::vector<int> cells = cellsOf(points, cells_per_side);
  std::vector<std::size_t> place(static_cast<std::size_t>(cells_per_side * cells_per_side * cells_per_side) + 1, 0);
  for (const int cell : cells) ++place[static_cast<std::size_t>(cell) + 1];
  std::partial_sum(place.begin(), place.end(), place.begin());
  for (std::size_t c = 0; c + 1 < place.size(); ++c)
    if (place[c] < place[c + 1])
      cells_.push_back({Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), place[c], place[c + 1]});
  index_of_.resize(size);
  for (std::size_t i = 0; i < size; ++i)
    index_of_[place[static_cast<std::size_t>(cells[i])]++] = static_cast<Eigen::Index>(i);
  for (int k = 0; k < 3; ++k) {
    std::vector<float>& coordinates = coordinates_[static_cast<std::size_t>(k)];
    coordinates.resize(size);
    for (std::size_t i = 0; i < size; ++i) coordinates[i] = points(k, index_of_[i]);
    for (Cell& cell : cells_) {
      const auto [least, most] = std::minmax_element(coordinates.begin() + static_cast<std::ptrdiff_t>(cell.begin),
                                                     coordinates.begin() + static_cast<std::ptrdiff_t>(cell.end));
      cell.least[k] = *least;
      cell.most[k] = *most;
    }
  }
}

Eigen::Vector3f OutermostPoints::last(const Eigen::Vector3f& direction) const {
  float most = -std::numeric_limits<float>::infinity();
  std::size_t found = 0;
  const auto lookAt = [&](const Cell& cell) {
    for (std::size_t i = cell.begin; i < cell.end; ++i) {
      const float value = along(direction, i);
      if (value < most || (value == most && index_of_[i] > index_of_[found])) continue;
      most = value;
      found = i;
    }
  };
  // The cell that may hold the farthest point first: it leaves few others.
  const auto first = std::max_element(cells_.begin(), cells_.end(), [&](const Cell& a, const Cell& b) {
    return a.bound(direction) < b.bound(direction);
  });
  lookAt(*first);
  for (const Cell& cell : cells_)
    if (cell.bound(direction) >= most) lookAt(cell);
  return {coordinates_[0][found], coordinates_[1][found], coordinates_[2][found]};
}

}  // namespace pcl_symmetry
