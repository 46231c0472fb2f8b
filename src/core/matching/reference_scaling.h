#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

namespace pcl_symmetry {

/// How near the nearest of a fixed set of other shapes lie: the mean distance to the \p num_nearest of them.
///
/// d(a, b) / sqrt(typical(a) typical(b)) compares shapes that many others resemble with shapes that stand apart; what
/// the others are need not be known.
/// \param distances to the shapes of the set; infinite ones (of the shape itself) do not count. \return > 0.
inline float typicalDistance(std::vector<float> distances, std::size_t num_nearest = 10) {
  distances.erase(std::remove(distances.begin(), distances.end(), std::numeric_limits<float>::infinity()),
                  distances.end());
  const std::size_t count = std::min(num_nearest, distances.size());
  if (count == 0) return 1.0f;
  std::partial_sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(count), distances.end());
  const float sum = std::accumulate(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(count), 0.0f);
  return std::max(sum / static_cast<float>(count), std::numeric_limits<float>::min());
}

}  // namespace pcl_symmetry
