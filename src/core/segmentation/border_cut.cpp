#include "core/segmentation/border_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "core/segmentation/graph_cut.h"

namespace pcl_symmetry {

namespace {

/// Distance of each element from the border between the sides, along the surface; infinite beyond the band.
std::vector<float> distanceFromBorder(const SurfaceGraph& graph, const std::vector<int>& side, float band) {
  std::vector<float> distance(side.size(), std::numeric_limits<float>::infinity());
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto reach = [&](int element, float d) {
    if (d > band || d >= distance[element]) return;
    distance[element] = d;
    queue.emplace(d, element);
  };
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    if (side[edge.from] < 0 || side[edge.to] < 0 || side[edge.from] == side[edge.to]) continue;
    reach(edge.from, 0.0f);
    reach(edge.to, 0.0f);
  }
  while (!queue.empty()) {
    const auto [d, element] = queue.top();
    queue.pop();
    if (d > distance[element]) continue;
    graph.visitNeighbors(element, [&, from = element, so_far = d](int to, const SurfaceGraph::Edge&) {
      if (side[to] >= 0) reach(to, so_far + (graph.centers.col(to) - graph.centers.col(from)).norm());
    });
  }
  return distance;
}

/// Elements that may change sides: the open ones and those in the band, without the farthest element of each side.
std::vector<int> movableElements(const std::vector<int>& side, const std::vector<float>& distance,
                                 const std::vector<int>& open) {
  const int size = static_cast<int>(side.size());
  std::vector<char> is_open(side.size(), 0);
  for (const int element : open) is_open[element] = 1;
  std::array<int, 2> farthest{-1, -1};
  for (int i = 0; i < size; ++i) {
    if (side[i] < 0 || is_open[i]) continue;
    int& far = farthest[side[i]];
    if (far < 0 || distance[i] > distance[far]) far = i;
  }
  std::vector<int> movable;
  for (int i = 0; i < size; ++i)
    if (side[i] >= 0 && i != farthest[side[i]] && (is_open[i] || !std::isinf(distance[i]))) movable.push_back(i);
  return movable;
}

/// The network of the cut: movable elements are nodes, side 0 is the source and side 1 the sink.
GraphCut networkOf(const SurfaceGraph& graph, const std::vector<int>& side, const std::vector<int>& movable,
                   double concavity_weight) {
  std::vector<int> node(side.size(), -1);
  for (std::size_t i = 0; i < movable.size(); ++i) node[movable[i]] = static_cast<int>(i);
  GraphCut cut;
  cut.to_source.assign(movable.size(), 0.0);
  cut.to_sink.assign(movable.size(), 0.0);
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    const int from = node[edge.from], to = node[edge.to];
    if (side[edge.from] < 0 || side[edge.to] < 0 || (from < 0 && to < 0)) continue;
    const double capacity = edge.length * std::exp(-concavity_weight * std::max(0.0f, edge.concavity));
    if (from >= 0 && to >= 0) {
      cut.edges.push_back({from, to, capacity});
    } else {
      const int fixed = from >= 0 ? edge.to : edge.from;
      (side[fixed] == 0 ? cut.to_source : cut.to_sink)[std::max(from, to)] += capacity;
    }
  }
  return cut;
}

}  // namespace

std::vector<int> cutBorder(const SurfaceGraph& graph, std::vector<int> side, const std::vector<int>& open,
                           const BorderCutOptions& options) {
  const std::vector<float> distance = distanceFromBorder(graph, side, static_cast<float>(options.band));
  const std::vector<int> movable = movableElements(side, distance, open);
  const std::vector<bool> with_first = networkOf(graph, side, movable, options.concavity_weight).solve();
  for (std::size_t i = 0; i < movable.size(); ++i) side[movable[i]] = with_first[i] ? 0 : 1;
  return side;
}

}  // namespace pcl_symmetry
