#include "core/surface/surface_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// Elements of the num_pieces largest connected pieces.
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

/// Patches that grow around seeds; each element belongs to the seed with the shortest way along the surface.
class GrowingPatches {
public:
  GrowingPatches(const SurfaceGraph& graph, float concave_detour)
      : graph_(graph),
        concave_detour_(concave_detour),
        distance_(static_cast<std::size_t>(graph.size()), std::numeric_limits<float>::infinity()),
        patch_(distance_.size(), -1) {}

  /// \return length of the way from the closest seed; infinite if no patch has reached the element.
  float distance(int element) const { return distance_[element]; }

  /// \return the patch of each element; -1 for none.
  const std::vector<int>& patches() const { return patch_; }

  /// Adds a patch, which takes the elements that are closer to its seed than to earlier ones.
  void addSeed(int seed) {
    distance_[seed] = 0.0f;
    patch_[seed] = num_patches_++;
    using Entry = std::pair<float, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    front.emplace(0.0f, seed);
    while (!front.empty()) {
      const auto [so_far, element] = front.top();
      front.pop();
      if (so_far > distance_[element]) continue;
      graph_.visitNeighbours(element, [&, from = element, reached = so_far](int to, const SurfaceGraph::Edge& edge) {
        const float step = (graph_.centers.col(to) - graph_.centers.col(from)).norm();
        const float there = reached + step * (1.0f + concave_detour_ * std::max(0.0f, edge.concavity));
        if (there >= distance_[to]) return;
        distance_[to] = there;
        patch_[to] = patch_[from];
        front.emplace(there, to);
      });
    }
  }

  int size() const { return num_patches_; }

private:
  const SurfaceGraph& graph_;
  const float concave_detour_;
  std::vector<float> distance_;
  std::vector<int> patch_;
  int num_patches_ = 0;
};

}  // namespace

std::vector<int> filledFromClosest(const SurfaceGraph& graph, std::vector<int> patch) {
  std::vector<int> reached, missed;
  for (int i = 0; i < graph.size(); ++i) (patch[i] >= 0 ? reached : missed).push_back(i);
  if (missed.empty()) return patch;
  const auto centersOf = [&](const std::vector<int>& elements) {
    Points centers(3, static_cast<Eigen::Index>(elements.size()));
    for (std::size_t k = 0; k < elements.size(); ++k)
      centers.col(static_cast<Eigen::Index>(k)) = graph.centers.col(elements[k]);
    return centers;
  };
  std::vector<int> closest;
  std::vector<float> sq_distances;
  makeTreeSearch(centersOf(reached))->search(centersOf(missed), 1, closest, sq_distances);
  for (std::size_t k = 0; k < missed.size(); ++k) patch[missed[k]] = patch[reached[closest[k]]];
  return patch;
}

std::vector<int> growPatches(const SurfaceGraph& graph, int num_patches, float concave_detour, int first) {
  GrowingPatches patches(graph, concave_detour);
  if (first >= 0) patches.addSeed(first);
  // The next seed is the element farthest from all seeds. Distances in the queue may be longer than they are now.
  std::priority_queue<std::pair<float, int>> farthest;
  for (const int element : elementsOfLargestPieces(graph, num_patches))
    if (graph.areas[element] > 0.0f) farthest.emplace(patches.distance(element), element);
  while (!farthest.empty()) {
    const auto [distance, element] = farthest.top();
    farthest.pop();
    if (distance > patches.distance(element)) {
      farthest.emplace(patches.distance(element), element);
      continue;
    }
    if (std::isfinite(distance) && patches.size() >= num_patches) break;
    patches.addSeed(element);
  }
  return filledFromClosest(graph, patches.patches());
}

}  // namespace pcl_symmetry
