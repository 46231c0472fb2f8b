#include "core/segmentation/border_smoothing.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace pcl_symmetry {

namespace {

/// Connected pieces of equal label.
struct Pieces {
  std::vector<int> of_element;
  std::vector<double> areas;                    ///< input units squared
  std::vector<int> labels;                      ///< of each piece
  std::vector<char> is_largest;                 ///< whether no piece of the same label is larger
  std::vector<std::map<int, double>> contacts;  ///< length of the border with each other label, input units
};

Pieces piecesOf(const SurfaceGraph& graph, const std::vector<int>& labels) {
  Pieces pieces;
  pieces.of_element = connectedPieces(graph, labels);
  const std::vector<int>& of = pieces.of_element;
  const auto num_pieces = 1 + static_cast<std::size_t>(*std::max_element(of.begin(), of.end()));
  pieces.areas.assign(num_pieces, 0.0);
  pieces.labels.assign(num_pieces, 0);
  for (int i = 0; i < graph.size(); ++i) {
    pieces.areas[of[i]] += graph.areas[i];
    pieces.labels[of[i]] = labels[i];
  }
  std::map<int, std::size_t> largest;
  for (std::size_t p = 0; p < num_pieces; ++p) {
    const auto [entry, is_new] = largest.emplace(pieces.labels[p], p);
    if (!is_new && pieces.areas[p] > pieces.areas[entry->second]) entry->second = p;
  }
  pieces.is_largest.assign(num_pieces, 0);
  for (const auto& [label, piece] : largest) pieces.is_largest[piece] = 1;
  pieces.contacts.resize(num_pieces);
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    const int a = of[edge.from], b = of[edge.to];
    if (a == b) continue;
    pieces.contacts[a][pieces.labels[b]] += edge.length;
    pieces.contacts[b][pieces.labels[a]] += edge.length;
  }
  return pieces;
}

}  // namespace

std::vector<int> smoothBorders(const SurfaceGraph& graph, std::vector<int> labels, const BorderCutOptions& options) {
  std::set<std::pair<int, int>> pairs;
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    const auto pair = std::minmax(labels[edge.from], labels[edge.to]);
    if (pair.first != pair.second) pairs.insert(pair);
  }
  for (const auto& [a, b] : pairs) {
    std::vector<int> side;
    for (const int label : labels) side.push_back(label == a ? 0 : label == b ? 1 : -1);
    side = cutBorder(graph, std::move(side), {}, options);
    for (std::size_t i = 0; i < side.size(); ++i)
      if (side[i] >= 0) labels[i] = side[i] == 0 ? a : b;
  }
  return labels;
}

std::vector<int> joinCrumbs(const SurfaceGraph& graph, const std::vector<int>& labels, double least_area) {
  const Pieces pieces = piecesOf(graph, labels);
  std::vector<int> moved = pieces.labels;
  for (std::size_t p = 0; p < moved.size(); ++p) {
    const std::map<int, double>& contacts = pieces.contacts[p];
    if (pieces.is_largest[p] || pieces.areas[p] >= least_area || contacts.empty()) continue;
    moved[p] = std::max_element(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
                 return a.second < b.second;
               })->first;
  }
  std::vector<int> result(labels.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = moved[pieces.of_element[i]];
  return result;
}

}  // namespace pcl_symmetry
