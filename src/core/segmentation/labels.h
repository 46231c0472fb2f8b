#pragma once

#include <vector>

#include "core/segmentation/part_evidence.h"
#include "pcl_symmetry/core/surface_segmentation.h"

namespace pcl_symmetry {

/// \param labels one per element of the graph; negative ones do not count.
/// \return the area of each label, input units squared.
std::vector<double> areasOf(const SurfaceGraph& graph, const std::vector<int>& labels);

/// \return the labels numbered from 0 in the order in which they appear.
std::vector<int> renumbered(std::vector<int> labels);

/// Gives each element without a label (-1) the label of the closest labeled element. At least one element has a label.
std::vector<int> filledFromClosest(const SurfaceGraph& graph, std::vector<int> labels);

/// Numbers segments by decreasing area, in labels and tree.
/// \param segmentation without images.
Segmentation numberedByArea(const SurfaceGraph& graph, Segmentation segmentation);

/// \return for each element, the one whose center is closest to its reflection.
std::vector<int> reflectedElements(const SurfaceGraph& graph, const ReflectionPlane& plane);

/// For each plane of PartEvidence::images, the segment that each segment is reflected onto: the one that receives most
/// of its area, patch by patch.
/// \param labels one per element, in [0, num_segments).
std::vector<std::vector<int>> segmentImages(const PartEvidence& evidence, const std::vector<int>& labels,
                                            int num_segments);

/// Replaces the segments on one side of a plane by the reflections of those on the other side. The side that is kept is
/// the one that leaves more of the surface unchanged. Segments that lie across the plane are their own reflections.
/// \param labels one per element, from 0.
/// \return new labels, from 0 without gaps.
std::vector<int> symmetrizedLabels(const SurfaceGraph& graph, const std::vector<int>& labels,
                                   const ReflectionPlane& plane, const std::vector<int>& reflected);

}  // namespace pcl_symmetry
