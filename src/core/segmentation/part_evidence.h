#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/triangles.h"
#include "core/segmentation/surface_patches.h"
#include "pcl_symmetry/core/surface_segmentation.h"

namespace pcl_symmetry {

/// The planes of a part of a surface and how much each element of the part contributes to them (Section 5.3).
struct SymmetryFeatures {
  std::vector<PartPlane> planes;  ///< significant maxima of the transform, strongest first
  Eigen::MatrixXf support;        ///< planes x elements, in [0, 1]: f at the reflections of the elements
  double radius = 0.0;            ///< radius of the part, input units
};

/// Finds the significant maxima of the transform of a part (Section 4.4) and the support of every element for them
/// ("how well does the face map onto the surface after reflection across the plane", Section 5.3).
/// \param elements elements of the part, with an area > 0.
/// \param seed seed of the samples of the part, in place of the seed in the options.
SymmetryFeatures symmetryFeatures(const SurfaceGraph& graph, const std::vector<int>& elements,
                                  const SegmentationOptions& options, std::uint64_t seed);

/// Evidence of the parts of a surface, measured on K small patches.
struct PartEvidence {
  Patches patches;
  std::vector<PatchBorder> borders;
  /// K median lengths of rays from the patch to the other side of the body (shape diameter, Shapira et al. 2008), in
  /// radii of the surface; 0 if no ray met another side.
  std::vector<double> thickness;
  /// K x K, symmetric: 1 if no surface lies between the positions half-way through the body behind two patches, else 0.
  Eigen::MatrixXf sight;
  std::vector<PartPlane> planes;  ///< planes of the whole surface, strongest first
  Eigen::MatrixXf support;        ///< planes x K, in [0, 1]: means over the elements of a patch, weighted by area
  /// For each plane with share >= kMappedShare: the patch at the reflection of the center of each patch.
  std::vector<std::vector<int>> images;

  int size() const { return patches.size(); }
};

/// Evidence shared by all divisions of one surface into patches.
class WholeEvidence {
public:
  /// \param graph N elements, kept by reference.
  WholeEvidence(const SurfaceGraph& graph, const SegmentationOptions& options);

  const SurfaceGraph& graph() const { return graph_; }
  const std::vector<PartPlane>& planes() const { return features_.planes; }

  /// Divides the surface into patches (over-segmentation) and gathers evidence.
  /// \param division number of the division, from 0; divisions with different numbers grow their patches from different
  /// seeds.
  PartEvidence ofDivision(int division) const;

private:
  const SurfaceGraph& graph_;
  const std::uint64_t seed_;
  SymmetryFeatures features_;
  std::optional<TriangleTree> tree_;
};

}  // namespace pcl_symmetry
