#include "pcl_symmetry/core/surface_graph.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/segmentation/labels.h"

namespace pcl_symmetry {

double SurfaceGraph::area() const {
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

std::vector<double> areasOf(const SurfaceGraph& graph, const std::vector<int>& labels) {
  std::vector<double> areas(1 + static_cast<std::size_t>(*std::max_element(labels.begin(), labels.end())), 0.0);
  for (int i = 0; i < graph.size(); ++i)
    if (labels[i] >= 0) areas[labels[i]] += graph.areas[i];
  return areas;
}

std::vector<int> byFallingArea(const std::vector<double>& areas) {
  std::vector<int> order(areas.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return areas[a] > areas[b]; });
  return order;
}

std::vector<int> renumbered(std::vector<int> labels) {
  std::map<int, int> number;
  for (int& label : labels) label = number.emplace(label, static_cast<int>(number.size())).first->second;
  return labels;
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
