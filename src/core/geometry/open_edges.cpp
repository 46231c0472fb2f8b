#include "core/geometry/open_edges.h"

#include <algorithm>
#include <numeric>

namespace pcl_symmetry {

std::vector<std::pair<int, int>> openEdges(const Points& vertices, const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<int> order(vertices.cols()), same(order.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](int a, int b) {
    for (int k = 0; k < 3; ++k)
      if (vertices(k, a) != vertices(k, b)) return vertices(k, a) < vertices(k, b);
    return false;
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return before(a, b) || (!before(b, a) && a < b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    same[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? same[order[i - 1]] : order[i];
  std::vector<std::pair<int, int>> edges, open;
  for (const Eigen::Vector3i& triangle : triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = same[triangle[k]], b = same[triangle[(k + 1) % 3]];
      if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if (end == i + 1) open.push_back(edges[i]);
    i = end;
  }
  return open;
}

}  // namespace pcl_symmetry
