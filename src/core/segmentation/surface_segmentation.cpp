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
  return DistinctPoints(graph.centers).points.cols() >= kSegmentation.fewest_points;
}

Segmentation oneSegment(const SurfaceGraph& graph) {
  Segmentation result;
  result.labels.assign(static_cast<std::size_t>(graph.size()), 0);
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
  if (!showsASurface(graph)) return oneSegment(graph);
  return options.method == SegmentationMethod::Splitting ? segmentBySplitting(graph, options)
                                                         : segmentByMerging(graph, options);
}

}  // namespace pcl_symmetry
