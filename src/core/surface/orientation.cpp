#include "core/surface/orientation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include "core/base/random.h"
#include "core/neighbours/triangle_tree.h"

namespace pcl_symmetry {

namespace {

/// Turns normals so that neighbours agree, where they do most surely first (Hoppe et al. 1992).
/// \return the connected piece of each element.
std::vector<int> alignNeighbours(SurfaceGraph& graph, const std::vector<float>& agreement) {
  struct Entry {
    float certainty;
    int element;
    float sign;
    bool operator<(const Entry& other) const { return certainty < other.certainty; }
  };
  std::vector<int> piece(static_cast<std::size_t>(graph.size()), -1);
  int num_pieces = 0;
  for (int start = 0; start < graph.size(); ++start) {
    if (piece[start] >= 0) continue;
    std::priority_queue<Entry> queue;
    queue.push({1.0f, start, 1.0f});
    while (!queue.empty()) {
      const Entry next = queue.top();
      queue.pop();
      if (piece[next.element] >= 0) continue;
      piece[next.element] = num_pieces;
      graph.normals.col(next.element) *= next.sign;
      graph.visitNeighbours(next.element, [&](int neighbour, const SurfaceGraph::Edge& edge) {
        const float agrees = agreement[&edge - graph.edges.data()];
        if (piece[neighbour] < 0) queue.push({std::abs(agrees), neighbour, agrees < 0.0f ? -next.sign : next.sign});
      });
    }
    ++num_pieces;
  }
  return piece;
}

}  // namespace

void orientNormals(SurfaceGraph& graph, const std::vector<float>& agreement) {
  constexpr int kNumRays = 2000;
  const std::vector<int> piece = alignNeighbours(graph, agreement);
  const int num_pieces = piece.empty() ? 0 : *std::max_element(piece.begin(), piece.end()) + 1;
  std::vector<std::vector<int>> members(static_cast<std::size_t>(num_pieces));
  for (int i = 0; i < graph.size(); ++i) members[piece[i]].push_back(i);
  const TriangleTree tree(graph.corners, graph.triangles);
  RandomStream random(1);
  for (const std::vector<int>& own : members) {
    const int num_rays = static_cast<int>(std::min<std::size_t>(own.size(), kNumRays));
    double escaped = 0.0;
    for (int k = 0; k < num_rays; ++k) {
      const int element = own[own.size() * k / num_rays];
      const Eigen::Vector3f n = graph.normals.col(element), center = graph.centers.col(element);
      const float reach = 2.0f * std::sqrt(graph.areas[element]);
      Eigen::Vector3f direction;
      for (int axis = 0; axis < 3; ++axis) direction[axis] = static_cast<float>(random.uniform() - 0.5);
      direction = (n + direction).normalized();
      // From beside the element itself: of a cloud, triangles about neighbouring points overlap.
      const bool out = tree.closest(center, direction, reach).triangle < 0;
      const bool in = tree.closest(center, Eigen::Vector3f(-direction), reach).triangle < 0;
      escaped += graph.areas[element] * (static_cast<double>(out) - static_cast<double>(in));
    }
    if (escaped < 0.0)
      for (const int element : own) graph.normals.col(element) *= -1.0f;
  }
}

}  // namespace pcl_symmetry
