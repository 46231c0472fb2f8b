#pragma once

#include <vector>

#include "pcl_symmetry/core/surface_segmentation.h"

namespace pcl_symmetry {

/// \param labels one per element of the graph; those below 0 do not count.
/// \return the area of each label, input units squared.
std::vector<double> areasOf(const SurfaceGraph& graph, const std::vector<int>& labels);

/// \return the indices of \p areas, greatest area first.
std::vector<int> byFallingArea(const std::vector<double>& areas);

/// \return the labels numbered from 0 in the order in which they appear.
std::vector<int> renumbered(std::vector<int> labels);

/// Gives the elements without a label, which is -1, that of the closest element which has one. One element has a label.
std::vector<int> filledFromClosest(const SurfaceGraph& graph, std::vector<int> labels);

/// Numbers segments by falling area, in labels and tree.
/// \param segmentation without images.
Segmentation numberedByArea(const SurfaceGraph& graph, Segmentation segmentation);

}  // namespace pcl_symmetry
