#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/segmentation/merging/regions.h"

namespace pcl_symmetry {

/// A plane that maps nearly all of the surface onto itself.
struct GlobalPlane {
  ReflectionPlane plane;
  std::size_t index;  ///< into PartEvidence::images
};

/// The strongest plane that maps at least 95 % of the surface onto itself.
std::optional<GlobalPlane> globalPlane(const PartEvidence& evidence);

/// Makes the regions on one side of a plane the reflections of those on the other side. The side whose regions are kept
/// is the one that leaves more of the surface unchanged. Regions that lie across the plane are their own reflections.
Regions mirroredRegions(const Regions& regions, const PartEvidence& evidence, const GlobalPlane& global);

/// For each plane of PartEvidence::images the segment that each segment is reflected onto: the one that receives most
/// of its area, patch by patch.
/// \param labels one per element, in [0, num_segments).
std::vector<std::vector<int>> segmentImages(const PartEvidence& evidence, const std::vector<int>& labels,
                                            int num_segments);

/// Copies labels across a plane: an element on its negative side gets the image of the segment at its reflection.
/// \param image the segment that each segment is reflected onto.
/// \return \p labels if two segments are not each other's image or a segment would vanish.
std::vector<int> mirroredLabels(const SurfaceGraph& graph, const std::vector<int>& labels,
                                const std::vector<int>& image, const ReflectionPlane& plane);

}  // namespace pcl_symmetry
