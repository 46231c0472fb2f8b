#pragma once

#include <vector>

#include "pcl_symmetry/core/segmentation/surface_segmentation.h"

namespace pcl_symmetry {

/// Where two patches meet.
struct PatchBorder {
  int from, to;
  double length;           ///< input units
  double edge_concavity;   ///< mean angle at the edges, radians, > 0: concave
  double patch_concavity;  ///< how far the normals of the two patches point towards each other, in [-2, 2]
};

/// What small patches of a surface tell about its parts.
struct PartEvidence {
  std::vector<int> patch;     ///< per element, in [0, K)
  std::vector<double> areas;  ///< K, shares of the whole
  Points centers, normals;    ///< 3 x K
  std::vector<PatchBorder> borders;
  std::vector<double> thickness;  ///< K, of the body behind the patch, in radii of the surface (the shape diameter)
  Eigen::MatrixXf sight;          ///< K x K, 1 where the body behind two patches is seen from one to the other, else 0
  std::vector<PartPlane> planes;  ///< of the whole surface, strongest first
  Eigen::MatrixXf support;        ///< planes x K, in [0, 1]
  /// Per plane that maps most of the surface onto itself: the patch at the reflection of each patch.
  std::vector<std::vector<int>> images;

  int size() const { return static_cast<int>(areas.size()); }
};

PartEvidence partEvidence(const SurfaceGraph& graph, const SegmentationOptions& options);

}  // namespace pcl_symmetry
