#pragma once

#include <vector>

#include "pcl_symmetry/core/surface/surface_graph.h"

namespace pcl_symmetry {

/// Cuts a surface into small patches of about equal size whose borders may follow concave edges.
/// \param num_patches >= 1, so many or few more. Each of the so many largest connected pieces has at least one; the
/// smaller ones share the patch that is closest.
/// \param concave_detour >= 0: a step over an edge of concavity c > 0 is 1 + concave_detour * c times as long.
/// \return the patch of each element, from 0.
std::vector<int> growPatches(const SurfaceGraph& graph, int num_patches, float concave_detour);

}  // namespace pcl_symmetry
