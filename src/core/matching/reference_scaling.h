#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

namespace pcl_symmetry {

/// The mean distance of a shape to the nearest shapes of a fixed reference set.
///
/// d(a, b) / sqrt(typical(a) typical(b)) compares distances of shapes that many others resemble with distances of
/// shapes that stand apart. The classes of the references need not be known.
/// \param distances to the references;
/// infinite ones, as to the shape itself, are left out.
/// \param num_nearest chosen: half varies with single references,
/// twice averages over shapes of other kinds.
/// \return > 0; 1 where no distance is left.
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
