#include "core/surface/surface_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// Elements of the largest connected pieces, at most so many pieces.
std::vector<int> elementsOfLargestPieces(const SurfaceGraph& graph, int num_pieces) {
  const std::vector<int> piece = connectedPieces(graph, std::vector<int>(static_cast<std::size_t>(graph.size()), 0));
  std::vector<double> areas(1 + static_cast<std::size_t>(*std::max_element(piece.begin(), piece.end())), 0.0);
  for (int i = 0; i < graph.size(); ++i) areas[piece[i]] += graph.areas[i];
  std::vector<int> order(areas.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return areas[a] > areas[b]; });
  std::vector<char> large(areas.size(), 0);
  for (std::size_t k = 0; k < order.size() && k < static_cast<std::size_t>(num_pieces); ++k)
    large[order[k]] = areas[order[k]] > 0.0;
  std::vector<int> elements;
  for (int i = 0; i < graph.size(); ++i)
    if (large[piece[i]]) elements.push_back(i);
  return elements;
}

/// Elements that no patch has reached get that of the closest one that has a patch.
void fillFromClosest(const SurfaceGraph& graph, std::vector<int>& patch) {
  std::vector<int> reached, missed;
  for (int i = 0; i < graph.size(); ++i) (patch[i] >= 0 ? reached : missed).push_back(i);
  if (missed.empty()) return;
  const auto centersOf = [&](const std::vector<int>& elements) {
    Points centers(3, static_cast<Eigen::Index>(elements.size()));
    for (std::size_t k = 0; k < elements.size(); ++k)
      centers.col(static_cast<Eigen::Index>(k)) = graph.centers.col(elements[k]);
    return centers;
  };
  std::vector<int> closest;
  std::vector<float> sq_distances;
  makeFlannSearch(centersOf(reached))->search(centersOf(missed), 1, closest, sq_distances);
  for (std::size_t k = 0; k < missed.size(); ++k) patch[missed[k]] = patch[reached[closest[k]]];
}

}  // namespace

std::vector<int> growPatches(const SurfaceGraph& graph, int num_patches, float concave_detour) {
  std::vector<float> distance(static_cast<std::size_t>(graph.size()), std::numeric_limits<float>::infinity());
  std::vector<int> patch(distance.size(), -1);
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  std::priority_queue<Entry> farthest;  // with distances that may have become shorter since
  for (const int element : elementsOfLargestPieces(graph, num_patches))
    if (graph.areas[element] > 0.0f) farthest.emplace(distance[element], element);
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
  fillFromClosest(graph, patch);
  return patch;
}

}  // namespace pcl_symmetry
