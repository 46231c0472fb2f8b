#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Indices of points along a curve through the cells of a grid (Morton's): those that follow each other are near.
/// \param points 3 x N, finite.
inline std::vector<int> curveOrder(const PointsRef& points) {
  constexpr int bits = 6;  // 64 cells along each side
  constexpr auto cells = static_cast<std::size_t>(1) << bits;
  std::array<std::uint32_t, cells> spread{};  // bits with room for those of two other axes before each
  for (std::size_t i = 0; i < cells; ++i)
    for (int bit = 0; bit < bits; ++bit) spread[i] |= static_cast<std::uint32_t>(i >> bit & 1u) << (3 * bit);
  const Eigen::Vector3f low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  const float extent = (high - low).maxCoeff();
  const float scale = extent > 0.0f ? static_cast<float>(cells) / extent : 0.0f;
  const auto at = [&](int axis, Eigen::Index i) {
    return spread[std::min(cells - 1, static_cast<std::size_t>((points(axis, i) - low[axis]) * scale))];
  };
  const auto count = static_cast<std::size_t>(points.cols());
  std::vector<std::uint32_t> cell(count);
  std::vector<int> next(cells * cells * cells + 1, 0), order(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    cell[i] = at(0, column) | at(1, column) << 1 | at(2, column) << 2;
    ++next[cell[i] + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t i = 0; i < count; ++i) order[static_cast<std::size_t>(next[cell[i]]++)] = static_cast<int>(i);
  return order;
}

}  // namespace pcl_symmetry
