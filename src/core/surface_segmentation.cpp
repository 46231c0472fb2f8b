#include "pcl_symmetry/core/surface_segmentation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "check.h"
#include "symmetry_splitting.h"

namespace pcl_symmetry {

namespace {

double areaOf(const SurfaceGraph& graph, const std::vector<int>& elements) {
  double area = 0.0;
  for (const int element : elements) area += graph.areas[element];
  return area;
}

/// Numbers segments by falling area.
void numberByArea(const SurfaceGraph& graph, Segmentation& segmentation) {
  std::vector<double> areas(static_cast<std::size_t>(segmentation.num_segments), 0.0);
  for (int i = 0; i < graph.size(); ++i) areas[segmentation.labels[i]] += graph.areas[i];
  std::vector<int> order(areas.size()), number(areas.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return areas[a] > areas[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) number[order[i]] = static_cast<int>(i);
  for (int& label : segmentation.labels) label = number[label];
  for (SegmentNode& node : segmentation.tree)
    if (node.segment >= 0) node.segment = number[node.segment];
}

/// The paper's recursion, the largest part first.
class Splitting {
public:
  Splitting(const SurfaceGraph& graph, const SegmentationOptions& options) : graph_(graph), options_(options) {}

  Segmentation run() {
    std::vector<int> all(static_cast<std::size_t>(graph_.size()));
    std::iota(all.begin(), all.end(), 0);
    add(-1, 0, std::move(all));
    int num_leaves = 1;
    for (int next; (next = largestOpen()) >= 0 && (options_.num_parts == 0 || num_leaves < options_.num_parts);) {
      open_[next] = false;
      num_leaves += split(next) ? 1 : 0;
      if (options_.progress) options_.progress(progress());
    }
    Segmentation result;
    result.labels.assign(static_cast<std::size_t>(graph_.size()), 0);
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      if (tree_[i].children[0] >= 0) continue;
      tree_[i].segment = result.num_segments++;
      for (const int element : elements_[i]) result.labels[element] = tree_[i].segment;
    }
    result.tree = std::move(tree_);
    numberByArea(graph_, result);
    return result;
  }

private:
  int add(int parent, int depth, std::vector<int> elements) {
    SegmentNode node;
    node.parent = parent;
    node.depth = depth;
    tree_.push_back(node);
    open_.push_back(areaOf(graph_, elements) > 0.0);
    elements_.push_back(std::move(elements));
    return static_cast<int>(tree_.size()) - 1;
  }

  int largestOpen() const {
    int largest = -1;
    double most = 0.0;
    for (std::size_t i = 0; i < tree_.size(); ++i) {
      if (!open_[i] || (options_.num_parts == 0 && tree_[i].depth >= options_.splitting.depth)) continue;
      const double area = areaOf(graph_, elements_[i]);
      if (area <= most) continue;
      largest = static_cast<int>(i);
      most = area;
    }
    return largest;
  }

  bool split(int index) {
    const SplittingOptions& splitting = options_.splitting;
    const SymmetryFeatures features =
        symmetryFeatures(graph_, elements_[index], splitting, options_.seed + index, options_.num_threads);
    tree_[index].planes = features.planes;
    const bool mixed = std::any_of(features.planes.begin(), features.planes.end(), [&](const PartPlane& plane) {
      return plane.share >= splitting.min_share && plane.share <= splitting.max_share;
    });
    if (!mixed) return false;
    auto sides = splitBySymmetry(graph_, elements_[index], features, splitting, options_.seed + index);
    if (!sides) return false;
    const int depth = tree_[index].depth + 1;
    const int first = add(index, depth, std::move(sides->first)), second = add(index, depth, std::move(sides->second));
    tree_[index].children[0] = first;
    tree_[index].children[1] = second;
    return true;
  }

  double progress() const {
    double open = 0.0;
    for (std::size_t i = 0; i < tree_.size(); ++i)
      if (open_[i] && (options_.num_parts > 0 || tree_[i].depth < options_.splitting.depth))
        open += areaOf(graph_, elements_[i]) * std::max(1, options_.splitting.depth - tree_[i].depth);
    return std::clamp(1.0 - open / (graph_.area() * std::max(1, options_.splitting.depth)), 0.0, 1.0);
  }

  const SurfaceGraph& graph_;
  const SegmentationOptions& options_;
  std::vector<SegmentNode> tree_;
  std::vector<std::vector<int>> elements_;
  std::vector<bool> open_;
};

}  // namespace

void SplittingOptions::validate() const {
  check(depth >= 0 && depth <= 30, "depth", depth, "in [0, 30]");
  check(min_share >= 0.0 && min_share <= max_share, "min_share", min_share, "in [0, max_share]");
  check(max_share <= 1.0, "max_share", max_share, "<= 1");
  check(strength >= 0.0 && strength <= 1.0, "strength", strength, "in [0, 1]");
  check(max_planes >= 1, "max_planes", max_planes, ">= 1");
  check(cut_band > 0.0, "cut_band", cut_band, "> 0");
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
  return Splitting(graph, options).run();
}

}  // namespace pcl_symmetry
