#include "core/segmentation/graph_cut.h"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>

#include "core/base/check.h"

namespace pcl_symmetry {

namespace {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;

/// One direction of an edge, as Boost.Graph wants it.
struct Arc {
  double capacity = 0.0, residual = 0.0;
  Traits::edge_descriptor reverse = {};
};

struct Node {
  boost::default_color_type color = boost::white_color;
  Traits::edge_descriptor predecessor = {};
  long distance = 0;
};

using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, Node, Arc>;

/// Adds an edge as two arcs that know each other.
void connect(Graph& graph, std::size_t from, std::size_t to, double forth, double back) {
  const auto arc = boost::add_edge(from, to, graph).first, reverse = boost::add_edge(to, from, graph).first;
  graph[arc].capacity = forth;
  graph[reverse].capacity = back;
  graph[arc].reverse = reverse;
  graph[reverse].reverse = arc;
}

}  // namespace

std::vector<bool> GraphCut::solve() const {
  const std::size_t size = to_source.size();
  check(to_sink.size() == size, "number of costs to the sink", to_sink.size(), "the number of costs to the source");
  Graph graph(size + 2);
  const std::size_t source = size, sink = size + 1;
  for (std::size_t i = 0; i < size; ++i) {
    check(to_source[i] >= 0.0 && to_sink[i] >= 0.0, "cost of a node", std::min(to_source[i], to_sink[i]), ">= 0");
    if (to_source[i] > 0.0) connect(graph, source, i, to_source[i], 0.0);
    if (to_sink[i] > 0.0) connect(graph, i, sink, to_sink[i], 0.0);
  }
  for (const Edge& edge : edges) {
    check(edge.from >= 0 && edge.to >= 0 && std::max(edge.from, edge.to) < static_cast<int>(size), "node of an edge",
          std::max(edge.from, edge.to), "in [0, number of nodes)");
    check(edge.capacity >= 0.0, "capacity", edge.capacity, ">= 0");
    connect(graph, edge.from, edge.to, edge.capacity, edge.capacity);
  }
  boost::boykov_kolmogorov_max_flow(graph, boost::get(&Arc::capacity, graph), boost::get(&Arc::residual, graph),
                                    boost::get(&Arc::reverse, graph), boost::get(&Node::predecessor, graph),
                                    boost::get(&Node::color, graph), boost::get(&Node::distance, graph),
                                    boost::get(boost::vertex_index, graph), source, sink);
  std::vector<bool> with_source(size);
  for (std::size_t i = 0; i < size; ++i) with_source[i] = graph[i].color == boost::black_color;
  return with_source;
}

}  // namespace pcl_symmetry
