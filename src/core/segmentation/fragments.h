#pragma once

#include <vector>

#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

/// Joins segments that are too small to be parts with the neighbor that they share most border with, or with the
/// closest segment if they have no neighbor; the smallest segment first.
/// \param labels one per element, from 0.
/// \param least_area of a segment that stays, input units squared.
/// \param most_segments that may stay, >= 1.
/// \return new labels, from 0 without gaps.
std::vector<int> joinSmallSegments(const SurfaceGraph& graph, std::vector<int> labels, double least_area,
                                   int most_segments);

}  // namespace pcl_symmetry
