#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// \return for each point the index of the first one at the same position; NaN are equal to nothing.
inline std::vector<int> firstCopies(const PointsRef& points) {
  const auto hash = [](const Eigen::Vector3f& point) {
    constexpr std::uint64_t factor = 0x9E3779B97F4A7C15u;  // 2^64 divided by the golden ratio, made odd
    std::uint64_t result = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float coordinate = point[axis] + 0.0f;  // 0 and -0 are equal
      std::uint32_t bits = 0;
      std::memcpy(&bits, &coordinate, sizeof bits);
      result = (result ^ bits) * factor;
      result ^= result >> 32;
    }
    return result;
  };
  std::vector<int> first(static_cast<std::size_t>(points.cols()));
  std::size_t num_slots = 1;
  while (num_slots < 2 * first.size()) num_slots *= 2;
  std::vector<int> first_of_slot(num_slots, -1);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Eigen::Vector3f point = points.col(i);
    std::size_t slot = hash(point) & (num_slots - 1);
    while (first_of_slot[slot] >= 0 && points.col(first_of_slot[slot]) != point) slot = (slot + 1) & (num_slots - 1);
    if (first_of_slot[slot] < 0) first_of_slot[slot] = static_cast<int>(i);
    first[i] = first_of_slot[slot];
  }
  return first;
}

/// The points without repetitions. Copies of a point are uninformative about the surface, and they hide the distance
/// between its samples.
struct DistinctPoints {
  Points points;              ///< 3 x M, each position once, in the order of the first copies
  std::vector<int> index_of;  ///< N, the column of points that holds each original point

  /// \param all 3 x N, finite.
  explicit DistinctPoints(const PointsRef& all) : points(3, all.cols()), index_of(firstCopies(all)) {
    int size = 0;
    for (int i = 0; i < static_cast<int>(index_of.size()); ++i) {
      const bool is_first = index_of[i] == i;
      if (is_first) points.col(size) = all.col(i);
      index_of[i] = is_first ? size++ : index_of[index_of[i]];
    }
    points.conservativeResize(3, size);
  }
};

}  // namespace pcl_symmetry
