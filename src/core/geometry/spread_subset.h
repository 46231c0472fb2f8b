#pragma once

#include <cstdint>
#include <vector>

#include "core/base/even_draw.h"
#include "core/geometry/curve_order.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

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
