#pragma once

#include <vector>

#include "core/segmentation/border_cut.h"
#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

/// Moves the border of each pair of neighboring labels to a minimum cut, so that it follows the surface instead of the
/// patches.
/// \param labels one per element, >= 0.
/// \return new labels.
std::vector<int> smoothBorders(const SurfaceGraph& graph, std::vector<int> labels, const BorderCutOptions& options);

/// Gives small pieces that are cut off from the rest of their label to the neighboring label with the longest border.
/// \param labels one per element, >= 0. The largest piece of each label stays.
/// \param least_area of a piece that stays, input units squared.
/// \return new labels.
std::vector<int> joinCrumbs(const SurfaceGraph& graph, const std::vector<int>& labels, double least_area);

}  // namespace pcl_symmetry
