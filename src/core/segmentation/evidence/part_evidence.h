#pragma once

#include <vector>

#include "core/segmentation/evidence/patches.h"
#include "pcl_symmetry/core/segmentation/surface_segmentation.h"

namespace pcl_symmetry {

/// What K small patches of a surface tell about its parts.
struct PartEvidence {
  Patches patches;
  std::vector<PatchBorder> borders;
  std::vector<double> thickness;  ///< K, as BodyEvidence
  Eigen::MatrixXf sight;          ///< K x K, as BodyEvidence
  std::vector<PartPlane> planes;  ///< of the whole surface, strongest first
  Eigen::MatrixXf support;        ///< planes x K, in [0, 1]: means over the elements of a patch, by area
  /// For each plane with share >= kMappedShare: the patch at the reflection of the center of each patch.
  std::vector<std::vector<int>> images;

  /// \return K.
  int size() const { return patches.size(); }
};

/// Divides a surface into patches (over-segmentation) and gathers the evidence that the options ask for.
PartEvidence partEvidence(const SurfaceGraph& graph, const SegmentationOptions& options);

}  // namespace pcl_symmetry
