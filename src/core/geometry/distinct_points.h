#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The points without repetitions. Copies of a point say nothing about the surface, and they hide the distance between
/// its samples.
struct DistinctPoints {
  Points points;              ///< 3 x M, each position once, in the order of the first copies
  std::vector<int> index_of;  ///< N, the column of points that holds each original point

  /// \param all 3 x N, finite.
  explicit DistinctPoints(const PointsRef& all)
      : points(3, all.cols()), index_of(static_cast<std::size_t>(all.cols())) {
    std::size_t num_slots = 1;
    while (num_slots < 2 * index_of.size()) num_slots *= 2;
    std::vector<int> first_of_slot(num_slots, -1);
    Eigen::Index size = 0;
    for (std::size_t i = 0; i < index_of.size(); ++i) {
      const Eigen::Vector3f point = all.col(static_cast<Eigen::Index>(i));
      std::size_t slot = hash(point) & (num_slots - 1);
      while (first_of_slot[slot] >= 0 && all.col(first_of_slot[slot]) != point) slot = (slot + 1) & (num_slots - 1);
      int& first = first_of_slot[slot];
      if (first < 0) {
        first = static_cast<int>(i);
        points.col(size) = point;
        index_of[i] = static_cast<int>(size++);
      } else {
        index_of[i] = index_of[static_cast<std::size_t>(first)];
      }
    }
    points.conservativeResize(3, size);
  }

private:
  static std::uint64_t hash(const Eigen::Vector3f& point) {
    constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15u;  // 2^64 divided by the golden ratio, made odd
    std::uint64_t result = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float coordinate = point[axis] + 0.0f;  // 0 and -0 are equal
      std::uint32_t bits = 0;
      std::memcpy(&bits, &coordinate, sizeof bits);
      result = (result ^ bits) * kFactor;
      result ^= result >> 32;
    }
    return result;
  }
};

}  // namespace pcl_symmetry
