#include "pcl_symmetry/core/surface_segmentation.h"

#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
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

/// \param result a segmentation whose number of parts differs from the wanted one.
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

/// \return for each point, the num_neighbors closest others, or all if there are fewer, nearest first.
std::vector<std::vector<int>> nearestOthers(const PointsRef& points, const ClosestPointSearch& search,
                                            int num_neighbors, int num_threads) {
  const auto size = static_cast<std::size_t>(points.cols());
  const std::size_t num_others = std::min<std::size_t>(num_neighbors, size - 1), num_found = num_others + 1;
  std::vector<std::vector<int>> neighbors(size);
  parallelPoints(size, num_threads, [&](std::size_t begin, std::size_t end) {
    std::vector<int> found;
    std::vector<float> sq_distances;
    search.search(points.middleCols(begin, end - begin), static_cast<int>(num_found), found, sq_distances);
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = (i - begin) * num_found; k < (i - begin + 1) * num_found; ++k)
        if (found[k] != static_cast<int>(i) && neighbors[i].size() < num_others) neighbors[i].push_back(found[k]);
  });
  return neighbors;
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

Segmentation segmentCloud(const PointsRef& points, std::size_t max_points, const SegmentationOptions& options) {
  constexpr int num_neighbors = 12;  // number of points that each point is joined with
  const auto size = static_cast<std::size_t>(points.cols());
  std::vector<std::size_t> drawn;
  if (size > max_points) drawn = oneOfEachRun(size, max_points, options.seed);
  const Points used = drawn.empty() ? Points(points) : Points(points(Eigen::all, drawn));
  const MakeSearch make_search = options.make_search ? options.make_search : makeFlannSearch;
  Segmentation result = segmentSurface(
      cloudGraph(used, nearestOthers(used, *make_search(used), num_neighbors, options.num_threads)), options);
  if (drawn.empty()) return result;
  const std::vector<int> labels = std::move(result.labels);
  result.labels.clear();
  for (const int closest : make_search(used)->closest(points)) result.labels.push_back(labels[closest]);
  for (std::size_t i = 0; i < drawn.size(); ++i) result.labels[drawn[i]] = labels[i];
  return result;
}

}  // namespace pcl_symmetry
