#pragma once

#include <vector>

#include "core/segmentation/region_merging.h"
#include "core/segmentation/surface_patches.h"
#include "pcl_symmetry/core/surface_segmentation.h"

namespace pcl_symmetry {

/// The tree of segments whose leaves are regions and whose inner nodes are their further merges, the last merge at the
/// root. Regions that no merge connects are joined at the top.
/// \param region_of_patch the region of each patch; regions are numbered as patches.
/// \param segment_of_region number of the segment of each region; -1 for a region that does not exist.
/// \return the root first, children after their parents.
std::vector<SegmentNode> segmentTree(const std::vector<int>& region_of_patch, const std::vector<int>& segment_of_region,
                                     const std::vector<Merge>& merges);

/// A segment for each patch: the one that holds most of it, but each segment has at least one patch.
/// \param labels one per element, from 0; at most as many segments as patches.
std::vector<int> segmentsOfPatches(const SurfaceGraph& graph, const Patches& patches, const std::vector<int>& labels);

/// Numbers segments by falling area, in labels and tree.
/// \param segmentation without images.
Segmentation numberedByArea(const SurfaceGraph& graph, Segmentation segmentation);

}  // namespace pcl_symmetry
