#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/geometry/point_samples.h"

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

/// Points spread over a cloud as its points are: one of each of equal runs along a curve through cells of a grid, so
/// that each neighborhood keeps its share.
struct SpreadSubset {
  std::vector<int> kept;    ///< different indices, in the order of the curve: those that follow each other are near
  std::vector<int> beside;  ///< N, a position in kept for each point of the cloud: mostly that of a point near it
};

/// \param points 3 x N, finite.
/// \param size of the subset, < N.
inline SpreadSubset spreadSubset(const PointsRef& points, std::size_t size, std::uint64_t seed) {
  const auto count = static_cast<std::size_t>(points.cols());
  const std::vector<int> order = curveOrder(points);
  SpreadSubset subset{{}, std::vector<int>(count)};
  const std::vector<std::size_t> positions = oneOfEachRun(count, size, seed);
  for (const std::size_t position : positions) subset.kept.push_back(order[position]);
  for (std::size_t position = 0, k = 0; position < count; ++position) {
    // The middle between two points that are kept is near either.
    while (k + 1 < size && positions[k] + positions[k + 1] < 2 * position) ++k;
    subset.beside[static_cast<std::size_t>(order[position])] = static_cast<int>(k);
  }
  return subset;
}

}  // namespace pcl_symmetry
