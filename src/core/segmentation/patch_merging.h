#pragma once

#include "pcl_symmetry/core/surface_segmentation.h"

namespace pcl_symmetry {

/// Segmentation by merging small patches as long as two regions are more likely one part than two. A departure from
/// Section 5.3: the paper's rule for the end hardly ever holds, and support for planes is one cue among several.
/// \param graph N elements with an area > 0.
/// \param options valid.
/// \return labels, tree and images.
Segmentation segmentByMerging(const SurfaceGraph& graph, const SegmentationOptions& options);

}  // namespace pcl_symmetry
