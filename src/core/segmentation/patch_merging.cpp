#include "core/segmentation/patch_merging.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/segmentation/evidence/part_evidence.h"
#include "core/segmentation/merging/border_smoothing.h"
#include "core/segmentation/merging/fragments.h"
#include "core/segmentation/merging/mirrored_labels.h"
#include "core/segmentation/merging/region_merging.h"
#include "core/segmentation/segment_tree.h"

namespace pcl_symmetry {

namespace {

/// chosen: rough shares of the time after which the evidence and the labels are done. They are for display only.
constexpr double kEvidenceShare = 0.7, kLabelsShare = 0.8;

/// Regions of whole patches that are parts.
Regions mergedPatches(const PartEvidence& evidence, const std::optional<GlobalPlane>& plane,
                      const SegmentationOptions& options) {
  const MergingOptions& merging = options.merging;
  Regions regions(evidence);
  const MergeSequence sequence = mergeRegions(regions, merging.evidence);
  if (options.num_parts > 0) {
    const int num_merges = evidence.size() - std::min(evidence.size(), options.num_parts);
    return merged(std::move(regions), sequence.merges,
                  std::min(sequence.merges.size(), static_cast<std::size_t>(num_merges)));
  }
  regions = merged(std::move(regions), sequence.merges, sequence.num_likely);
  regions = joinFragments(std::move(regions), evidence, merging.least_area);
  if (plane) regions = joinFragments(mirroredRegions(regions, evidence, *plane), evidence, merging.least_area);
  return regions;
}

/// The region of each element, with borders that follow the surface instead of the patches.
LabelledRegions labelledElements(const SurfaceGraph& graph, const PartEvidence& evidence, Regions regions,
                                 const SegmentationOptions& options) {
  const MergingOptions& merging = options.merging;
  std::vector<int> labels;
  for (const int patch : evidence.patches.of_element) labels.push_back(regions.ofPatches()[patch]);
  LabelledRegions labelled{std::move(regions), std::move(labels)};
  if (merging.cut_band == 0.0) return labelled;
  BorderCutOptions cut;
  cut.band = merging.cut_band * std::sqrt(graph.area());
  cut.concavity_weight = merging.evidence != MergingEvidence::Symmetry ? merging.concavity_weight : 0.0;
  const double least_area = merging.least_area * graph.area();
  labelled.labels = joinCrumbs(graph, smoothBorders(graph, std::move(labelled.labels), cut), least_area);
  if (options.num_parts > 0) return labelled;
  return joinEmptiedRegions(std::move(labelled), graph, evidence, least_area);
}

/// Segments with the tree of their further merges.
Segmentation segmentsOf(const SurfaceGraph& graph, const PartEvidence& evidence, const LabelledRegions& labelled,
                        MergingEvidence kind) {
  const Regions& regions = labelled.regions;
  Segmentation result;
  std::vector<int> segment_of_region(static_cast<std::size_t>(regions.size()), -1);
  for (int r = 0; r < regions.size(); ++r)
    if (regions.exists(r)) segment_of_region[r] = result.num_segments++;
  for (const int region : labelled.labels) result.labels.push_back(segment_of_region[region]);
  result.tree = segmentTree(regions.ofPatches(), segment_of_region, mergeRegions(regions, kind).merges);
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
  const PartEvidence evidence = partEvidence(graph, options);
  tell(kEvidenceShare);
  const bool agree = options.merging.agree_across_planes && options.num_parts == 0;
  const std::optional<GlobalPlane> plane = agree ? globalPlane(evidence) : std::nullopt;
  Regions regions = mergedPatches(evidence, plane, options);
  const LabelledRegions labelled = labelledElements(graph, evidence, std::move(regions), options);
  tell(kLabelsShare);
  Segmentation result = segmentsOf(graph, evidence, labelled, options.merging.evidence);
  if (plane) result.labels = mirroredLabels(graph, result.labels, result.images[plane->index], plane->plane);
  tell(1.0);
  return result;
}

}  // namespace pcl_symmetry
