#pragma once

#include <algorithm>
#include <tuple>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// The points without repetitions. Copies of a point say nothing about the surface, and they hide the distance between
/// its samples.
struct DistinctPoints {
  Points points;              ///< 3 x M, each position once, in the order of the first copies
  std::vector<int> index_of;  ///< N, the column of points that holds each original point

  /// \param all 3 x N, finite.
  explicit DistinctPoints(const PointsRef& all) : index_of(static_cast<std::size_t>(all.cols())) {
    struct Entry {
      float x, y, z;
      int index;
    };
    std::vector<Entry> sorted(index_of.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const auto point = all.col(static_cast<Eigen::Index>(i));
      sorted[i] = {point.x(), point.y(), point.z(), static_cast<int>(i)};
    }
    std::sort(sorted.begin(), sorted.end(), [](const Entry& a, const Entry& b) {
      return std::tie(a.x, a.y, a.z, a.index) < std::tie(b.x, b.y, b.z, b.index);
    });
    std::vector<int> first_of(sorted.size());  // the first copy of each point
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const Entry& own = sorted[i];
      const Entry& before = sorted[i > 0 ? i - 1 : 0];
      const bool is_copy = i > 0 && std::tie(own.x, own.y, own.z) == std::tie(before.x, before.y, before.z);
      first_of[own.index] = is_copy ? first_of[before.index] : own.index;
    }
    points.resize(3, all.cols());
    Eigen::Index size = 0;
    for (std::size_t i = 0; i < first_of.size(); ++i) {
      const bool is_first = first_of[i] == static_cast<int>(i);
      if (is_first) points.col(size) = all.col(static_cast<Eigen::Index>(i));
      index_of[i] = is_first ? static_cast<int>(size++) : index_of[first_of[i]];
    }
    points.conservativeResize(3, size);
  }
};

}  // namespace pcl_symmetry
