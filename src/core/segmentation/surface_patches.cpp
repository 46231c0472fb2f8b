#include "core/segmentation/surface_patches.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/segmentation/labels.h"

namespace pcl_symmetry {

namespace {

/// Elements of the num_pieces largest connected pieces.
std::vector<int> elementsOfLargestPieces(const SurfaceGraph& graph, int num_pieces) {
  const std::vector<int> piece = connectedPieces(graph, std::vector<int>(static_cast<std::size_t>(graph.size()), 0));
  const std::vector<double> areas = areasOf(graph, piece);
  std::vector<int> largest = descendingOrder(areas);
  largest.resize(std::min(largest.size(), static_cast<std::size_t>(num_pieces)));
  std::vector<char> large(areas.size(), 0);
  for (const int p : largest) large[p] = areas[p] > 0.0;
  std::vector<int> elements;
  for (int i = 0; i < graph.size(); ++i)
    if (large[piece[i]]) elements.push_back(i);
  return elements;
}

/// Patches that grow around seeds; each element belongs to the seed with the shortest path along the surface.
class GrowingPatches {
public:
  GrowingPatches(const SurfaceGraph& graph, float concave_detour)
      : graph_(graph),
        distance_(static_cast<std::size_t>(graph.size()), std::numeric_limits<float>::infinity()),
        patch_(distance_.size(), -1) {
    for (const SurfaceGraph::Edge& edge : graph.edges) {
      const float step = (graph.centers.col(edge.to) - graph.centers.col(edge.from)).norm();
      lengths_.push_back(step * (1.0f + concave_detour * std::max(0.0f, edge.concavity)));
    }
  }

  /// \return length of the path from the closest seed; infinite if no patch has reached the element.
  float distance(int element) const { return distance_[element]; }

  /// \return the patch of each element; -1 for none.
  const std::vector<int>& patches() const { return patch_; }

  /// Adds a patch, which takes the elements that are closer to its seed than to earlier ones.
  void addSeed(int seed) {
    checkCancelled();
    const int patch = num_patches_++;
    distance_[seed] = 0.0f;
    patch_[seed] = patch;
    front_.emplace(0.0f, seed);
    while (!front_.empty()) {
      const Way way = front_.top();
      front_.pop();
      if (way.first > distance_[way.second]) continue;
      graph_.visitNeighbors(way.second, [&](int to, const SurfaceGraph::Edge& edge) {
        const float there = way.first + lengths_[&edge - graph_.edges.data()];
        if (there >= distance_[to]) return;
        distance_[to] = there;
        patch_[to] = patch;
        front_.emplace(there, to);
      });
    }
  }

  int size() const { return num_patches_; }

private:
  const SurfaceGraph& graph_;
  std::vector<float> lengths_;  ///< lengths of the steps across edges, with the detour for concave ones, input units
  std::vector<float> distance_;
  std::vector<int> patch_;
  using Way = std::pair<float, int>;  ///< length and element
  std::priority_queue<Way, std::vector<Way>, std::greater<>> front_;
  int num_patches_ = 0;
};

}  // namespace

std::vector<int> growPatches(const SurfaceGraph& graph, int num_patches, float concave_detour, int first) {
  GrowingPatches patches(graph, concave_detour);
  if (first >= 0) patches.addSeed(first);
  std::vector<int> elements = elementsOfLargestPieces(graph, num_patches);
  eraseIf(elements, [&](int i) { return !(graph.areas[i] > 0.0f); });
  // Each large piece has a seed. After that, the next seed is the element farthest from all seeds.
  std::vector<int> others;
  for (auto element = elements.rbegin(); element != elements.rend(); ++element) {
    if (std::isinf(patches.distance(*element)))
      patches.addSeed(*element);
    else
      others.push_back(*element);
  }
  std::vector<std::pair<float, int>> ways;
  for (const int element : others) ways.emplace_back(patches.distance(element), element);
  std::priority_queue farthest(std::less<>(), std::move(ways));
  while (!farthest.empty() && patches.size() < num_patches) {
    const auto [distance, element] = farthest.top();
    farthest.pop();
    if (distance > patches.distance(element))
      farthest.emplace(patches.distance(element), element);  // a seed has come closer in the meantime
    else
      patches.addSeed(element);
  }
  return filledFromClosest(graph, patches.patches());
}

Patches measuredPatches(const SurfaceGraph& graph, std::vector<int> of_element) {
  Patches patches;
  patches.of_element = std::move(of_element);
  const std::vector<int>& patch = patches.of_element;
  const int size = *std::max_element(patch.begin(), patch.end()) + 1;
  const double whole = graph.area();
  patches.areas.assign(size, 0.0);
  Eigen::Matrix3Xd centers = Eigen::Matrix3Xd::Zero(3, size), normals = centers;
  for (int i = 0; i < graph.size(); ++i) {
    const double area = graph.areas[i] / whole;
    patches.areas[patch[i]] += area;
    centers.col(patch[i]) += area * graph.centers.col(i).cast<double>();
    normals.col(patch[i]) += area * graph.normals.col(i).cast<double>();
  }
  for (int p = 0; p < size; ++p)
    if (patches.areas[p] > 0.0) centers.col(p) /= patches.areas[p];
  patches.centers = centers.cast<float>();
  for (int p = 0; p < size; ++p) normals.col(p) = normals.col(p).stableNormalized();
  patches.normals = normals.cast<float>();
  return patches;
}

std::vector<PatchBorder> patchBorders(const SurfaceGraph& graph, const Patches& patches) {
  std::map<std::pair<int, int>, PatchBorder> borders;
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    const auto ends = std::minmax(patches.of_element[edge.from], patches.of_element[edge.to]);
    if (ends.first == ends.second) continue;
    PatchBorder& border = borders.insert({ends, {ends.first, ends.second, 0.0, 0.0, 0.0}}).first->second;
    border.length += edge.length;
    border.edge_concavity += static_cast<double>(edge.length) * edge.concavity;
  }
  std::vector<PatchBorder> result;
  for (auto& [ends, border] : borders) {
    if (border.length > 0.0) border.edge_concavity /= border.length;
    const Eigen::Vector3f step = patches.centers.col(border.to) - patches.centers.col(border.from);
    const Eigen::Vector3f difference = patches.normals.col(border.from) - patches.normals.col(border.to);
    border.patch_concavity = difference.dot(step.stableNormalized());
    result.push_back(border);
  }
  return result;
}

}  // namespace pcl_symmetry
