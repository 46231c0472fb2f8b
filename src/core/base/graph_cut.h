#pragma once

#include <vector>

namespace pcl_symmetry {

/// A minimum cut between a source and a sink (Boykov and Kolmogorov 2004).
struct GraphCut {
  struct Edge {
    int from, to;
    double capacity;  ///< >= 0, both ways
  };

  /// What it costs a node to be cut from the source, or from the sink; >= 0.
  std::vector<double> to_source, to_sink;
  std::vector<Edge> edges;

  /// \return per node whether it stays with the source.
  /// \throws std::invalid_argument for another number of costs to the source than to the sink, an edge to a node that
  /// does not exist, or a negative capacity.
  std::vector<bool> solve() const;
};

}  // namespace pcl_symmetry
