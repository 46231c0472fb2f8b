#pragma once

#include <vector>

#include "core/segmentation/region_merging.h"
#include "pcl_symmetry/core/surface_graph.h"
#include "pcl_symmetry/core/surface_segmentation.h"

namespace pcl_symmetry {

/// Segmentation by merging small patches as long as two regions are more likely one part than two (Section 5.3).
/// Departure from the paper: its stopping rule hardly ever applies; here support for planes is one cue among several.
/// \param graph N elements with an area > 0.
Segmentation segmentByMerging(const SurfaceGraph& graph, const SegmentationOptions& options);

/// Cuts a surface into parts that several divisions agree on.
///
/// The Rand distance counts pairs of elements. The parts with the least expected distance therefore hold the pairs that
/// are one part with a mean probability above 1/2: neighbors with the highest mean are merged until it falls below 1/2.
/// \param divisions of the same elements, at least one.
/// \param num_parts 0: merging ends at 1/2; otherwise at this number of parts, or at pieces that no edge connects.
/// \return the part of each element, from 0.
std::vector<int> consensus(const SurfaceGraph& graph, const std::vector<MergedDivision>& divisions, int num_parts);

}  // namespace pcl_symmetry
