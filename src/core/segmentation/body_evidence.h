#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/geometry/triangle_tree.h"
#include "core/segmentation/patches.h"

namespace pcl_symmetry {

/// What rays through the body behind a surface tell about its K patches.
struct BodyEvidence {
  /// K, median length of rays from the patch to the other side of the body (shape diameter, Shapira et al. 2008), in
  /// radii of the surface; 0 if no ray met another side.
  std::vector<double> thickness;
  /// K x K, symmetric: 1 if no surface lies between the positions half-way through the body behind two patches, else 0.
  Eigen::MatrixXf sight;
};

/// Sends rays through the body behind each patch.
/// \param tree of the triangles of the graph.
/// \param seed of rays and samples.
BodyEvidence bodyEvidence(const SurfaceGraph& graph, const TriangleTree& tree, const Patches& patches,
                          std::uint64_t seed);

/// The evidence of a surface without an inside: thickness 0, and a patch sees itself alone.
BodyEvidence noBodyEvidence(int num_patches);

}  // namespace pcl_symmetry
