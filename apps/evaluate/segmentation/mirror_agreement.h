/// Whether the segments of a symmetric surface are each other's mirror images.
#pragma once

#include "pcl_symmetry/core/segmentation/surface_segmentation.h"

namespace pcl_symmetry::apps {

/// Share of the area whose reflection in the strongest global plane lies in the segment that is said to be the image of
/// its own, in [0, 1]. Global is a plane that reflects \p min_share of the area onto the surface; NaN where there is
/// none.
double mirrorAgreement(const SurfaceGraph& graph, const Segmentation& segmentation, double min_share = 0.95);

}  // namespace pcl_symmetry::apps
