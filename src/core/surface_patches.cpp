#include "surface_patches.h"

#include <cmath>
#include <limits>
#include <queue>

namespace pcl_symmetry {

std::vector<int> growPatches(const SurfaceGraph& graph, int num_patches, float concave_detour) {
  std::vector<float> distance(static_cast<std::size_t>(graph.size()), std::numeric_limits<float>::infinity());
  std::vector<int> patch(distance.size(), -1);
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  std::priority_queue<Entry> farthest;  // with distances that may have become shorter since
  for (int i = graph.size() - 1; i >= 0; --i)
    if (graph.areas[i] > 0.0f) farthest.emplace(distance[i], i);
  for (int next = 0; !farthest.empty();) {
    const auto [d, seed] = farthest.top();
    farthest.pop();
    if (d > distance[seed]) {
      farthest.emplace(distance[seed], seed);
      continue;
    }
    if (std::isfinite(d) && next >= num_patches) break;
    distance[seed] = 0.0f;
    patch[seed] = next++;
    front.emplace(0.0f, seed);
    while (!front.empty()) {
      const auto [so_far, element] = front.top();
      front.pop();
      if (so_far > distance[element]) continue;
      graph.visitNeighbours(element, [&, from = element, reached = so_far](int to, const SurfaceGraph::Edge& edge) {
        const float step = (graph.centers.col(to) - graph.centers.col(from)).norm();
        const float there = reached + step * (1.0f + concave_detour * std::max(0.0f, edge.concavity));
        if (there >= distance[to]) return;
        distance[to] = there;
        patch[to] = patch[from];
        front.emplace(there, to);
      });
    }
  }
  for (int& p : patch)
    if (p < 0) p = 0;  // without area and neighbours
  return patch;
}

}  // namespace pcl_symmetry
