#pragma once

#include <vector>

#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

/// Where the border between two sides may run and what it costs.
struct BorderCutOptions {
  /// Elements within this distance of the old border, along the surface, may change sides; input units, >= 0.
  double band = 0.0;
  /// The cost of an edge is length * exp(-concavity_weight * max(0, concavity)), with concavity in radians; >= 0. With
  /// 0, only the length counts, as in the paper.
  double concavity_weight = 0.0;
};

/// Moves the border between two sides of a surface to the minimum cut (Section 5.3: "a weighted min-cut along the edges
/// of the mesh"; Boykov and Kolmogorov 2004).
/// \param side N values: 0 or 1; -1 for an element of neither side, which stays.
/// \param open elements that may change sides at any distance from the border.
/// \param options band and costs. If a whole side lies within the band, its farthest element keeps its side.
std::vector<int> cutBorder(const SurfaceGraph& graph, std::vector<int> side, const std::vector<int>& open,
                           const BorderCutOptions& options);

/// Moves the border of each pair of neighboring labels to a minimum cut, so that it follows the surface instead of the
/// patches.
/// \param labels one per element, >= 0.
std::vector<int> smoothBorders(const SurfaceGraph& graph, std::vector<int> labels, const BorderCutOptions& options);

/// Gives small pieces that are cut off from the rest of their label to the neighboring label with the longest border.
/// \param labels one per element, >= 0. The largest piece of each label keeps it.
/// \param min_area least area of other pieces that keep their label, input units squared.
std::vector<int> joinCrumbs(const SurfaceGraph& graph, const std::vector<int>& labels, double min_area);

/// Joins segments that are too small to be parts with the neighbor with which they share the longest border, or with
/// the closest segment if they have no neighbor; the smallest segment first. A segment of a cloud is no larger than its
/// share of the points.
/// \param labels one per element, from 0.
/// \param min_area least area of a segment that is kept, input units squared.
/// \param max_segments greatest number of segments that are kept, >= 1.
/// \return new labels, from 0 without gaps.
std::vector<int> joinSmallSegments(const SurfaceGraph& graph, std::vector<int> labels, double min_area,
                                   int max_segments);

}  // namespace pcl_symmetry
