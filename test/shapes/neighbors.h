#pragma once

#include <vector>

#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry::test {

/// For each point the indices of its \p count nearest other points, nearest first.
inline std::vector<std::vector<int>> neighborsOf(const Points& points, int count) {
  std::vector<int> indices;
  std::vector<float> sq_distances;
  makeFlannSearch(points)->search(points, count + 1, indices, sq_distances);
  std::vector<std::vector<int>> neighbors(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    for (int k = 0; k <= count; ++k)
      if (indices[i * (count + 1) + k] != i) neighbors[i].push_back(indices[i * (count + 1) + k]);
  for (auto& own : neighbors) own.resize(count);
  return neighbors;
}

}  // namespace pcl_symmetry::test
