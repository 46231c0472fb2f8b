#pragma once

#include <vector>

#include "pcl_symmetry/core/surface/surface_graph.h"

namespace pcl_symmetry {

/// Divides a surface into small patches of about equal size, whose borders prefer concave edges (over-segmentation).
///
/// Each of the num_patches largest connected pieces has at least one patch; smaller pieces belong to the closest patch.
/// \param graph N elements.
/// \param num_patches >= 1; there may be a few more or fewer patches.
/// \param concave_detour >= 0, per radian: a step across an edge of concavity c > 0 is 1 + concave_detour * c times as
/// long.
/// \return the patch of each element, from 0.
std::vector<int> growPatches(const SurfaceGraph& graph, int num_patches, float concave_detour);

}  // namespace pcl_symmetry
