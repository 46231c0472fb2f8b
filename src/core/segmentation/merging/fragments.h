#pragma once

#include <vector>

#include "core/segmentation/merging/regions.h"

namespace pcl_symmetry {

/// Joins regions that are too small to be parts with the neighbour that they share most border with, or with the
/// closest region if they have no neighbour; the smallest region first.
/// \param least_area share of the surface.
Regions joinFragments(Regions regions, const PartEvidence& evidence, double least_area);

/// Regions and the region of each element. Borders between labels may differ from those between patches.
struct LabelledRegions {
  Regions regions;
  std::vector<int> labels;  ///< one per element
};

/// Joins regions that moved borders have left too little area, as joinFragments().
/// \param least_area input units squared.
LabelledRegions joinEmptiedRegions(LabelledRegions labelled, const SurfaceGraph& graph, const PartEvidence& evidence,
                                   double least_area);

}  // namespace pcl_symmetry
