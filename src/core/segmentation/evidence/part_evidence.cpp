#include "core/segmentation/evidence/part_evidence.h"

#include <numeric>
#include <utility>

#include "core/segmentation/evidence/body_evidence.h"
#include "core/segmentation/evidence/symmetry_features.h"
#include "core/surface/surface_patches.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// chosen: how much patches avoid growing across concave edges, as growPatches(), per radian. At half, patches reach
/// around the borders of parts; at twice, they become long and thin along creases.
constexpr float kConcaveDetour = 4.0f;

SymmetryFeatures featuresOfWhole(const SurfaceGraph& graph, const SegmentationOptions& options) {
  std::vector<int> all(static_cast<std::size_t>(graph.size()));
  std::iota(all.begin(), all.end(), 0);
  return symmetryFeatures(graph, all, options.splitting, options.seed, options.num_threads);
}

/// Means of the support of the elements of each patch, weighted by area.
Eigen::MatrixXf supportOfPatches(const SurfaceGraph& graph, const Patches& patches, const Eigen::MatrixXf& support) {
  Eigen::MatrixXf means = Eigen::MatrixXf::Zero(support.rows(), patches.size());
  const double whole = graph.area();
  for (int i = 0; i < graph.size(); ++i) {
    const int p = patches.of_element[i];
    if (patches.areas[p] > 0.0)
      means.col(p) += static_cast<float>(graph.areas[i] / (whole * patches.areas[p])) * support.col(i);
  }
  return means;
}

/// The patch at the reflection of the center of each patch, for each plane that maps enough of the surface onto itself.
std::vector<std::vector<int>> imagesOfPatches(const Patches& patches, const std::vector<PartPlane>& planes) {
  std::vector<std::vector<int>> images;
  const auto search = makeTreeSearch(patches.centers);
  for (const PartPlane& plane : planes) {
    if (plane.share < kMappedShare) continue;
    Points reflected(3, patches.size());
    for (int p = 0; p < patches.size(); ++p)
      reflected.col(p) = plane.plane.reflect(patches.centers.col(p).cast<double>()).cast<float>();
    std::vector<float> sq_distances;
    search->search(reflected, 1, images.emplace_back(), sq_distances);
  }
  return images;
}

}  // namespace

PartEvidence partEvidence(const SurfaceGraph& graph, const SegmentationOptions& options) {
  const MergingEvidence kind = options.merging.evidence;
  const float concave_detour = kind != MergingEvidence::Symmetry ? kConcaveDetour : 0.0f;
  PartEvidence evidence;
  evidence.patches = measuredPatches(graph, growPatches(graph, options.merging.num_patches, concave_detour));
  evidence.borders = patchBorders(graph, evidence.patches);
  BodyEvidence body = kind == MergingEvidence::All
                          ? bodyEvidence(graph, evidence.patches, options.seed, options.num_threads)
                          : noBodyEvidence(evidence.size());
  evidence.thickness = std::move(body.thickness);
  evidence.sight = std::move(body.sight);
  SymmetryFeatures features = featuresOfWhole(graph, options);
  evidence.planes = std::move(features.planes);
  evidence.support = supportOfPatches(graph, evidence.patches, features.support);
  evidence.images = imagesOfPatches(evidence.patches, evidence.planes);
  return evidence;
}

}  // namespace pcl_symmetry
