#include "pcl_symmetry/core/surface_segmentation.h"

#include "core/base/check.h"
#include "core/geometry/point_samples.h"
#include "core/segmentation/patch_merging.h"
#include "core/segmentation/segmentation_rules.h"
#include "core/segmentation/symmetry_splitting.h"

namespace pcl_symmetry {

namespace {

bool showsASurface(const SurfaceGraph& graph) {
  if (!graph.is_cloud) return true;
  return DistinctPoints(graph.centers).points.cols() >= kMinDistinctPoints;
}

/// \param result of another number of parts than is wanted.
std::string reasonOf(const SurfaceGraph& graph, const Segmentation& result, const SegmentationOptions& options) {
  const std::string text =
      "num_parts = " + std::to_string(options.num_parts) + ", " + std::to_string(result.num_segments) + " possible: ";
  if (!showsASurface(graph)) return text + "so few points show no surface";
  if (result.num_segments > options.num_parts) return text + "pieces that nothing connects are parts";
  if (options.method == SegmentationMethod::Splitting) return text + "no plane tells more apart";
  return text + "parts are made of about " + std::to_string(kSegmentation.num_patches) +
         " patches, or of faces where there are fewer";
}

Segmentation oneSegment(const SurfaceGraph& graph) {
  Segmentation result;
  result.labels.assign(graph.size(), 0);
  result.num_segments = 1;
  result.tree.emplace_back().segment = 0;
  return result;
}

}  // namespace

void SplittingOptions::validate() const {
  check(depth >= 0 && depth <= 30, "depth", depth, "in [0, 30]");
  check(concavity_weight >= 0.0, "concavity_weight", concavity_weight, ">= 0");
}

void SegmentationOptions::validate() const {
  splitting.validate();
  check(num_parts >= 0, "num_parts", num_parts, ">= 0");
  checkNumThreads(num_threads);
}

Segmentation segmentSurface(const SurfaceGraph& graph, const SegmentationOptions& options) {
  options.validate();
  check(graph.size() > 0 && graph.area() > 0.0, "area of the surface", graph.area(), "> 0");
  Segmentation result = !showsASurface(graph)                             ? oneSegment(graph)
                        : options.method == SegmentationMethod::Splitting ? segmentBySplitting(graph, options)
                                                                          : segmentByMerging(graph, options);
  if (options.num_parts > 0 && result.num_segments != options.num_parts)
    result.reason = reasonOf(graph, result, options);
  return result;
}

}  // namespace pcl_symmetry
