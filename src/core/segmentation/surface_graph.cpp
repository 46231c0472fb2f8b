#include "pcl_symmetry/core/surface_graph.h"

#include <numeric>

namespace pcl_symmetry {

double SurfaceGraph::area() const {
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::vector<int> connectedPieces(const SurfaceGraph& graph, const std::vector<int>& labels) {
  std::vector<int> pieces(labels.size(), -1), stack;
  int num_pieces = 0;
  for (int start = 0; start < graph.size(); ++start) {
    if (pieces[start] >= 0 || labels[start] < 0) continue;
    pieces[start] = num_pieces;
    stack.push_back(start);
    while (!stack.empty()) {
      const int element = stack.back();
      stack.pop_back();
      graph.visitNeighbors(element, [&](int neighbor, const SurfaceGraph::Edge&) {
        if (pieces[neighbor] >= 0 || labels[neighbor] != labels[start]) return;
        pieces[neighbor] = num_pieces;
        stack.push_back(neighbor);
      });
    }
    ++num_pieces;
  }
  return pieces;
}

}  // namespace pcl_symmetry
