#include "core/segmentation/patch_merging.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/segmentation/consensus.h"
#include "core/segmentation/merge_fit.h"
#include "core/segmentation/mirrored_labels.h"
#include "core/segmentation/part_evidence.h"
#include "core/segmentation/segment_borders.h"
#include "core/segmentation/segment_tree.h"

namespace pcl_symmetry {

namespace {

/// The plane across which labels have to agree, and the element at the reflection of each.
struct Mirror {
  GlobalPlane global;
  std::vector<int> reflected;
};

std::optional<Mirror> mirrorOf(const WholeEvidence& whole, const SegmentationOptions& options) {
  if (!options.merging.agree_across_planes || options.num_parts > 0) return std::nullopt;
  const std::optional<GlobalPlane> global = globalPlane(whole.planes());
  if (!global) return std::nullopt;
  return Mirror{*global, reflectedElements(whole.graph(), global->plane)};
}

/// Borders that follow the surface instead of the patches, equal on both sides of the mirror, and no small segments.
std::vector<int> refinedLabels(const SurfaceGraph& graph, std::vector<int> labels, const std::optional<Mirror>& mirror,
                               int most_segments, const SegmentationOptions& options) {
  const MergingOptions& merging = options.merging;
  const double least_area = options.num_parts == 0 ? merging.least_area * graph.area() : 0.0;
  labels = joinSmallSegments(graph, std::move(labels), least_area, most_segments);
  if (merging.cut_band > 0.0) {
    BorderCutOptions cut;
    cut.band = merging.cut_band * std::sqrt(graph.area());
    cut.concavity_weight = merging.concavity_weight;
    labels = joinCrumbs(graph, smoothBorders(graph, std::move(labels), cut), merging.least_area * graph.area());
  }
  if (mirror) labels = mirroredLabels(graph, labels, mirror->global.plane, mirror->reflected);
  return joinSmallSegments(graph, std::move(labels), least_area, most_segments);
}

/// Segments with the tree of their further merges and their images, by the patches of one division.
Segmentation segmentsOf(const SurfaceGraph& graph, const PartEvidence& evidence, std::vector<int> labels,
                        const MergeWeights& weights) {
  Segmentation result;
  result.labels = std::move(labels);
  result.num_segments = 1 + *std::max_element(result.labels.begin(), result.labels.end());
  const std::vector<int> segment_of_patch = segmentsOfPatches(graph, evidence.patches, result.labels);
  std::vector<int> segment_of_region(segment_of_patch.size(), -1), first(segment_of_patch.size(), -1);
  Regions regions(evidence);
  for (int p = 0; p < evidence.size(); ++p) {
    const int segment = segment_of_patch[p];
    if (first[segment] >= 0) {
      regions.merge(first[segment], p);
    } else {
      first[segment] = p;
      segment_of_region[p] = segment;
    }
  }
  result.tree = segmentTree(regions.ofPatches(), segment_of_region, mergeRegions(regions, weights));
  result.tree[0].planes = evidence.planes;
  result = numberedByArea(graph, std::move(result));
  result.images = segmentImages(evidence, result.labels, result.num_segments);
  return result;
}

}  // namespace

Segmentation segmentByMerging(const SurfaceGraph& graph, const SegmentationOptions& options) {
  const auto tell = [&](double share) {
    if (options.progress) options.progress(share);
  };
  const WholeEvidence whole(graph, options);
  tell(0.3);
  const MergeWeights& weights = kMergeFit[static_cast<std::size_t>(options.merging.evidence)];
  const auto num_divisions = static_cast<std::size_t>(options.merging.num_divisions);
  std::vector<MergedDivision> divisions(num_divisions);
  std::optional<PartEvidence> first;
  parallelBlocks(num_divisions, options.num_threads, [&](std::size_t d) {
    PartEvidence evidence = whole.ofDivision(static_cast<int>(d));
    divisions[d] = mergedDivision(evidence, weights, options.num_parts);
    if (d == 0) first = std::move(evidence);
  });
  tell(0.8);
  const std::optional<Mirror> mirror = mirrorOf(whole, options);
  for (std::size_t d = 0; mirror && d < num_divisions; ++d)
    divisions.push_back(reflectedDivision(divisions[d], mirror->reflected));
  std::vector<int> labels =
      refinedLabels(graph, consensus(graph, divisions, options.num_parts), mirror, first->size(), options);
  Segmentation result = segmentsOf(graph, *first, std::move(labels), weights);
  tell(1.0);
  return result;
}

}  // namespace pcl_symmetry
