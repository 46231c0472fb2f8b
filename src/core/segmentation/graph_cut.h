#pragma once

#include <vector>

namespace pcl_symmetry {

/// A minimum cut of a network of N nodes between a source and a sink (Boykov and Kolmogorov 2004).
struct GraphCut {
  struct Edge {
    int from, to;     ///< nodes, in [0, N)
    double capacity;  ///< cost of separating the two nodes, >= 0, the same in both directions
  };

  std::vector<double> to_source;  ///< N, cost of separating a node from the source, >= 0
  std::vector<double> to_sink;    ///< N, cost of separating a node from the sink, >= 0
  std::vector<Edge> edges;

  /// \return for each node whether it stays with the source in the cut with the least total cost.
  /// \throws std::invalid_argument if to_source and to_sink differ in size, an edge has a node out of range, or a cost
  /// is negative.
  std::vector<bool> solve() const;
};

}  // namespace pcl_symmetry
