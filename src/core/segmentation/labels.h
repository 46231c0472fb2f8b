#pragma once

#include <vector>

#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

/// \param labels one per element of the graph; those below 0 do not count.
/// \return the area of each label, input units squared.
std::vector<double> areasOf(const SurfaceGraph& graph, const std::vector<int>& labels);

/// \return the indices of \p areas, greatest area first.
std::vector<int> byFallingArea(const std::vector<double>& areas);

/// \return the labels numbered from 0 in the order in which they appear.
std::vector<int> renumbered(std::vector<int> labels);

}  // namespace pcl_symmetry
