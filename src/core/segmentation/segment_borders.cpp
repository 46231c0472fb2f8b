#include "core/segmentation/segment_borders.h"

#include <algorithm>
#include <array>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/property_map/function_property_map.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/segmentation/adjacency.h"
#include "core/segmentation/labels.h"

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

/// Elements that may change sides: the open ones and those in the band, except the farthest element of each side.
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

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using Network = boost::adjacency_list<
    boost::vecS, boost::vecS, boost::directedS,
    boost::property<boost::vertex_color_t, boost::default_color_type,
                    boost::property<boost::vertex_predecessor_t, Traits::edge_descriptor,
                                    boost::property<boost::vertex_distance_t, long>>>,
    boost::property<boost::edge_capacity_t, double,
                    boost::property<boost::edge_residual_capacity_t, double,
                                    boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>>;

/// Adds an edge as two arcs that know each other.
void connect(Network& network, std::size_t from, std::size_t to, double forth, double back) {
  const auto arc = boost::add_edge(from, to, network).first, reverse = boost::add_edge(to, from, network).first;
  boost::put(boost::edge_capacity, network, arc, forth);
  boost::put(boost::edge_capacity, network, reverse, back);
  boost::put(boost::edge_reverse, network, arc, reverse);
  boost::put(boost::edge_reverse, network, reverse, arc);
}

/// The network of the cut: movable elements are nodes, followed by side 0 as the source and side 1 as the sink.
Network networkOf(const SurfaceGraph& graph, const std::vector<int>& side, const std::vector<int>& movable,
                  double concavity_weight) {
  const int size = static_cast<int>(movable.size());
  std::vector<int> node(side.size(), -1);
  for (int i = 0; i < size; ++i) node[movable[i]] = i;
  struct Edge {
    int from, to;
    double capacity;
  };
  std::vector<Edge> edges;
  std::array<std::vector<double>, 2> to_side{std::vector<double>(size, 0.0), std::vector<double>(size, 0.0)};
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    const int from = node[edge.from], to = node[edge.to];
    if (side[edge.from] < 0 || side[edge.to] < 0 || (from < 0 && to < 0)) continue;
    const double capacity = edge.length * std::exp(-concavity_weight * std::max(0.0f, edge.concavity));
    if (from >= 0 && to >= 0)
      edges.push_back({from, to, capacity});
    else
      to_side[side[from >= 0 ? edge.to : edge.from]][std::max(from, to)] += capacity;
  }
  Network network(size + 2);
  for (int i = 0; i < size; ++i) {
    if (to_side[0][i] > 0.0) connect(network, size, i, to_side[0][i], 0.0);
    if (to_side[1][i] > 0.0) connect(network, i, size + 1, to_side[1][i], 0.0);
  }
  for (const Edge& edge : edges) connect(network, edge.from, edge.to, edge.capacity, edge.capacity);
  return network;
}

/// Connected pieces of equal label.
struct Pieces {
  std::vector<int> of_element;
  std::vector<double> areas;     ///< area of each piece, input units squared
  std::vector<int> labels;       ///< label of each piece
  std::vector<char> is_largest;  ///< whether no piece of the same label is larger
  /// For each piece, the length of its border with each other label, input units.
  std::vector<std::map<int, double>> contacts;
};

Pieces piecesOf(const SurfaceGraph& graph, const std::vector<int>& labels) {
  Pieces pieces;
  pieces.of_element = connectedPieces(graph, labels);
  const std::vector<int>& of = pieces.of_element;
  pieces.areas = areasOf(graph, of);
  const std::size_t num_pieces = pieces.areas.size();
  pieces.labels.assign(num_pieces, 0);
  for (int i = 0; i < graph.size(); ++i) pieces.labels[of[i]] = labels[i];
  std::set<int> seen;
  pieces.is_largest.assign(num_pieces, 0);
  for (const int p : descendingOrder(pieces.areas)) pieces.is_largest[p] = seen.insert(pieces.labels[p]).second;
  pieces.contacts.resize(num_pieces);
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    const int a = of[edge.from], b = of[edge.to];
    if (a == b) continue;
    pieces.contacts[a][pieces.labels[b]] += edge.length;
    pieces.contacts[b][pieces.labels[a]] += edge.length;
  }
  return pieces;
}

/// \param lengths lengths by label, not empty.
int labelOfMost(const std::map<int, double>& lengths) {
  const auto shorter = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::max_element(lengths.begin(), lengths.end(), shorter)->first;
}

/// Segments with their areas and the lengths of their common borders, input units.
class SmallSegments {
public:
  SmallSegments(const SurfaceGraph& graph, std::vector<int> labels)
      : graph_(graph),
        labels_(std::move(labels)),
        borders_(1 + static_cast<std::size_t>(*std::max_element(labels_.begin(), labels_.end()))),
        most_of_element_(graph.is_cloud ? graph.area() / graph.size() : std::numeric_limits<double>::infinity()) {
    for (int i = 0; i < graph.size(); ++i) {
      areas_[labels_[i]] += graph.areas[i];
      ++num_elements_[labels_[i]];
    }
    for (const SurfaceGraph::Edge& edge : graph.edges) {
      const int a = labels_[edge.from], b = labels_[edge.to];
      if (a != b) borders_.add(a, b, edge.length);
    }
  }

  int size() const { return static_cast<int>(areas_.size()); }
  /// In a cloud, the area is at most the segment's share of the points, because the area of a point among few others is
  /// a guess.
  double area(int segment) const { return std::min(areas_.at(segment), num_elements_.at(segment) * most_of_element_); }

  int smallest() const {
    return std::min_element(areas_.begin(), areas_.end(),
                            [this](const auto& a, const auto& b) { return area(a.first) < area(b.first); })
        ->first;
  }

  /// The segment that a small segment is joined with.
  int hostOf(int segment) const {
    const std::map<int, double>& lengths = borders_.borders(segment);
    return lengths.empty() ? closestTo(segment) : labelOfMost(lengths);
  }

  void join(int host, int segment) {
    areas_[host] += areas_[segment];
    num_elements_[host] += num_elements_[segment];
    areas_.erase(segment);
    std::replace(labels_.begin(), labels_.end(), segment, host);
    borders_.join(host, segment);
  }

  std::vector<int> labels() const {
    std::map<int, int> number;
    for (const auto& [segment, area] : areas_) number.emplace(segment, static_cast<int>(number.size()));
    std::vector<int> labels;
    for (const int label : labels_) labels.push_back(number.at(label));
    return labels;
  }

private:
  /// The segment with the element that is closest to the mean of a segment.
  int closestTo(int segment) const {
    std::vector<int> own, others;
    for (int i = 0; i < graph_.size(); ++i) (labels_[i] == segment ? own : others).push_back(i);
    const Eigen::Vector3f mean = centerOfMass(graph_.centers(Eigen::all, own)).cast<float>();
    Eigen::Index closest = 0;
    (graph_.centers(Eigen::all, others).colwise() - mean).colwise().squaredNorm().minCoeff(&closest);
    return labels_[others[closest]];
  }

  const SurfaceGraph& graph_;
  std::vector<int> labels_;
  std::map<int, double> areas_;      ///< by segment
  std::map<int, int> num_elements_;  ///< by segment
  Adjacency<double> borders_;        ///< lengths of the common borders
  double most_of_element_;           ///< greatest area that an element counts for, on average over its segment
};

}  // namespace

std::vector<int> cutBorder(const SurfaceGraph& graph, std::vector<int> side, const std::vector<int>& open,
                           const BorderCutOptions& options) {
  const std::vector<float> distance = distanceFromBorder(graph, side, static_cast<float>(options.band));
  const std::vector<int> movable = movableElements(side, distance, open);
  Network network = networkOf(graph, side, movable, options.concavity_weight);
  checkCancelled();
  std::size_t num_looked_up = 0;
  const auto index = boost::make_function_property_map<std::size_t>([&](std::size_t node) {
    if (++num_looked_up % 65536 == 0) checkCancelled();
    return node;
  });
  boost::boykov_kolmogorov_max_flow(
      network, boost::get(boost::edge_capacity, network), boost::get(boost::edge_residual_capacity, network),
      boost::get(boost::edge_reverse, network), boost::get(boost::vertex_predecessor, network),
      boost::get(boost::vertex_color, network), boost::get(boost::vertex_distance, network), index, movable.size(),
      movable.size() + 1);
  for (std::size_t i = 0; i < movable.size(); ++i)
    side[movable[i]] = boost::get(boost::vertex_color, network, i) == boost::black_color ? 0 : 1;
  return side;
}

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

std::vector<int> joinCrumbs(const SurfaceGraph& graph, const std::vector<int>& labels, double min_area) {
  const Pieces pieces = piecesOf(graph, labels);
  std::vector<int> moved = pieces.labels;
  for (std::size_t p = 0; p < moved.size(); ++p) {
    const std::map<int, double>& contacts = pieces.contacts[p];
    if (pieces.is_largest[p] || pieces.areas[p] >= min_area || contacts.empty()) continue;
    moved[p] = labelOfMost(contacts);
  }
  std::vector<int> result(labels.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = moved[pieces.of_element[i]];
  return result;
}

std::vector<int> joinSmallSegments(const SurfaceGraph& graph, std::vector<int> labels, double min_area,
                                   int max_segments) {
  SmallSegments segments(graph, std::move(labels));
  while (segments.size() > 1) {
    const int smallest = segments.smallest();
    if (segments.area(smallest) >= min_area && segments.size() <= max_segments) break;
    segments.join(segments.hostOf(smallest), smallest);
  }
  return segments.labels();
}

}  // namespace pcl_symmetry
