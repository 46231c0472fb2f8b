#include "core/segmentation/part_evidence.h"

#include <numeric>
#include <utility>

#include "core/base/random.h"
#include "core/geometry/reflected_points.h"
#include "core/segmentation/body_evidence.h"
#include "core/segmentation/segmentation_rules.h"
#include "core/segmentation/surface_patches.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

namespace {

SymmetryFeatures featuresOfWhole(const SurfaceGraph& graph, const SegmentationOptions& options) {
  std::vector<int> all(static_cast<std::size_t>(graph.size()));
  std::iota(all.begin(), all.end(), 0);
  return symmetryFeatures(graph, all, options.splitting, options.seed, options.num_threads, options.make_search);
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
  const auto search = makeFlannSearch(patches.centers);
  for (const PartPlane& plane : planes) {
    if (plane.share < kMappedShare) continue;
    std::vector<float> sq_distances;
    search->search(reflectedPoints(patches.centers, plane.plane), 1, images.emplace_back(), sq_distances);
  }
  return images;
}

/// The element where the first patch of a division grows, drawn by area; -1 for the first division: the usual one.
int firstSeed(const SurfaceGraph& graph, int division, std::uint64_t seed) {
  if (division == 0) return -1;
  double left = RandomStream(seed).uniform() * graph.area();
  int element = 0;
  while (element + 1 < graph.size() && (left -= graph.areas[element]) > 0.0) ++element;
  return element;
}

}  // namespace

WholeEvidence::WholeEvidence(const SurfaceGraph& graph, const SegmentationOptions& options)
    : graph_(graph), merging_(options.merging), seed_(options.seed), features_(featuresOfWhole(graph, options)) {
  if (merging_.evidence == MergingEvidence::All) tree_.emplace(graph.corners, graph.triangles);
}

PartEvidence WholeEvidence::ofDivision(int division) const {
  const std::uint64_t seed = seed_ + static_cast<std::uint64_t>(division);
  PartEvidence evidence;
  evidence.patches = measuredPatches(graph_, growPatches(graph_, merging_.num_patches, kSegmentation.concave_detour,
                                                         firstSeed(graph_, division, seed)));
  evidence.borders = patchBorders(graph_, evidence.patches);
  BodyEvidence body = tree_ ? bodyEvidence(graph_, *tree_, evidence.patches, seed) : noBodyEvidence(evidence.size());
  evidence.thickness = std::move(body.thickness);
  evidence.sight = std::move(body.sight);
  evidence.planes = features_.planes;
  evidence.support = supportOfPatches(graph_, evidence.patches, features_.support);
  evidence.images = imagesOfPatches(evidence.patches, evidence.planes);
  return evidence;
}

}  // namespace pcl_symmetry
