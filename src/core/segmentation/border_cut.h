#pragma once

#include <vector>

#include "pcl_symmetry/core/surface/surface_graph.h"

namespace pcl_symmetry {

/// Draws the border between two sides of a surface anew: the minimum cut within a band around it, with capacities
/// length * exp(-concavity_weight * c), c > 0 the concavity of an edge in radians.
/// \param side per element 0, 1 or -1 (neither: stays so). \param open elements that may change sides wherever they
/// are. \param band the distance along the surface within which the cut may lie, input units; of a side that lies
/// within it as a whole the farthest element stays.
void cutBorder(const SurfaceGraph& graph, std::vector<int>& side, const std::vector<int>& open, double band,
               double concavity_weight);

}  // namespace pcl_symmetry
