#pragma once

#include "pcl_symmetry/core/surface_segmentation.h"

namespace pcl_symmetry {

/// The paper's segmentation (Section 5.3): parts are split in two, the largest part first, until the depth or the
/// number of parts is reached or no plane maps between 10 % and 90 % of a part onto itself.
/// \param graph N elements with an area > 0.
/// \return labels and tree; no images.
Segmentation segmentBySplitting(const SurfaceGraph& graph, const SegmentationOptions& options);

}  // namespace pcl_symmetry
