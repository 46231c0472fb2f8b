#pragma once

#include <vector>

#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

/// Where the border between two sides may run and what it costs.
struct BorderCutOptions {
  /// Elements within this distance of the old border, along the surface, may change sides; input units, >= 0.
  double band = 0.0;
  /// The cost of an edge is length * exp(-concavity_weight * max(0, concavity)), concavity in radians; >= 0. With 0 the
  /// length alone counts, as in the paper.
  double concavity_weight = 0.0;
};

/// Moves the border between two sides of a surface to the minimum cut (Section 5.3: "a weighted min-cut along the edges
/// of the mesh").
/// \param graph N elements.
/// \param side N values: 0 or 1; -1 for an element of neither side, which stays.
/// \param open elements that may change sides at any distance from the border.
/// \param options band and costs. If a whole side lies within the band, its farthest element stays.
/// \return N sides.
std::vector<int> cutBorder(const SurfaceGraph& graph, std::vector<int> side, const std::vector<int>& open,
                           const BorderCutOptions& options);

}  // namespace pcl_symmetry
