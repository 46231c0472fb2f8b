#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/base/even_draw.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Points spread over a cloud as its points are: one of each of equal runs along a curve through cells of a grid, so
/// that each neighbourhood keeps its share.
struct SpreadSubset {
  std::vector<int> kept;    ///< different indices, in the order of the curve: those that follow each other are near
  std::vector<int> beside;  ///< N, a place in kept for each point of the cloud: mostly that of a point near it
};

/// \param points 3 x N, finite.
/// \param size of the subset, < N.
inline SpreadSubset spreadSubset(const PointsRef& points, std::size_t size, std::uint64_t seed) {
  // Cells along each side, as a power of 2. chosen: at half, a cell holds many runs, in which the choice is random; at
  // twice, eight times as many cells are counted.
  constexpr int kBits = 6;
  constexpr auto kCells = static_cast<std::size_t>(1) << kBits;
  std::array<std::uint32_t, kCells> spread{};  // bits with two places free before each, for a curve of cells (Morton's)
  for (std::size_t i = 0; i < kCells; ++i)
    for (int bit = 0; bit < kBits; ++bit) spread[i] |= static_cast<std::uint32_t>(i >> bit & 1u) << (3 * bit);
  const Eigen::Vector3f low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  const float extent = (high - low).maxCoeff();
  const float scale = extent > 0.0f ? static_cast<float>(kCells) / extent : 0.0f;
  const auto at = [&](int axis, Eigen::Index i) {
    return spread[std::min(kCells - 1, static_cast<std::size_t>((points(axis, i) - low[axis]) * scale))];
  };
  const auto count = static_cast<std::size_t>(points.cols());
  std::vector<std::uint32_t> cell(count);
  std::vector<int> next(kCells * kCells * kCells + 1, 0), order(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    cell[i] = at(0, column) | at(1, column) << 1 | at(2, column) << 2;
    ++next[cell[i] + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t i = 0; i < count; ++i) order[static_cast<std::size_t>(next[cell[i]]++)] = static_cast<int>(i);
  SpreadSubset subset{{}, std::vector<int>(count)};
  const std::vector<std::size_t> places = oneOfEachRun(count, size, seed);
  for (const std::size_t place : places) subset.kept.push_back(order[place]);
  for (std::size_t place = 0, k = 0; place < count; ++place) {
    // The middle between two points that are kept is near either.
    while (k + 1 < size && places[k] + places[k + 1] < 2 * place) ++k;
    subset.beside[static_cast<std::size_t>(order[place])] = static_cast<int>(k);
  }
  return subset;
}

}  // namespace pcl_symmetry
