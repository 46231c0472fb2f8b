#include "core/segmentation/segment_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/segmentation/labels.h"

namespace pcl_symmetry {

namespace {

/// Binary joins of leaves. A node below num_leaves is a leaf, node num_leaves + i is join i.
struct Joins {
  int num_leaves = 0, root = 0;
  std::vector<std::pair<int, int>> children;  ///< of each join
};

Joins joinsOf(const std::vector<int>& region_of_patch, const std::vector<int>& segment_of_region,
              const std::vector<Merge>& merges) {
  Joins joins;
  joins.num_leaves = 1 + *std::max_element(segment_of_region.begin(), segment_of_region.end());
  std::vector<int> node = segment_of_region;   // the topmost node that a region belongs to
  std::vector<int> current = region_of_patch;  // the region that each patch belongs to by now
  const auto join = [&](int into, int from) {
    if (into == from) return;
    joins.children.emplace_back(node[into], node[from]);
    node[into] = joins.num_leaves + static_cast<int>(joins.children.size()) - 1;
    std::replace(current.begin(), current.end(), from, into);
  };
  for (const Merge& merge : merges) join(current[merge.into], current[merge.from]);
  for (const int region : std::vector<int>(current)) join(current[0], current[region]);
  joins.root = node[current[0]];
  return joins;
}

}  // namespace

std::vector<SegmentNode> segmentTree(const std::vector<int>& region_of_patch, const std::vector<int>& segment_of_region,
                                     const std::vector<Merge>& merges) {
  const Joins joins = joinsOf(region_of_patch, segment_of_region, merges);
  std::vector<SegmentNode> tree;
  std::vector<std::pair<int, int>> open{{joins.root, -1}};  // nodes with the index of their parent in the tree
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto [join, parent] = open[i];
    const int index = static_cast<int>(tree.size());
    SegmentNode node;
    node.parent = parent;
    if (parent >= 0) {
      SegmentNode& above = tree[parent];
      node.depth = above.depth + 1;
      above.children[above.children[0] < 0 ? 0 : 1] = index;
    }
    if (join < joins.num_leaves) {
      node.segment = join;
    } else {
      const auto [first, second] = joins.children[join - joins.num_leaves];
      open.emplace_back(first, index);
      open.emplace_back(second, index);
    }
    tree.push_back(node);
  }
  return tree;
}

std::vector<int> segmentsOfPatches(const SurfaceGraph& graph, const Patches& patches, const std::vector<int>& labels) {
  const int num_segments = 1 + *std::max_element(labels.begin(), labels.end());
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(num_segments, patches.size());
  for (int i = 0; i < graph.size(); ++i) shared(labels[i], patches.of_element[i]) += graph.areas[i];
  std::vector<int> segment(static_cast<std::size_t>(patches.size()), -1);
  // The segment with the smallest hold on any patch chooses first.
  std::vector<int> order(static_cast<std::size_t>(num_segments));
  std::iota(order.begin(), order.end(), 0);
  const Eigen::VectorXd most = shared.rowwise().maxCoeff();
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return most[a] < most[b]; });
  for (const int s : order) {
    int best = -1;
    for (int p = 0; p < patches.size(); ++p)
      if (segment[p] < 0 && (best < 0 || shared(s, p) > shared(s, best))) best = p;
    if (best >= 0) segment[best] = s;
  }
  for (int p = 0; p < patches.size(); ++p) {
    if (segment[p] >= 0) continue;
    Eigen::Index largest = 0;
    shared.col(p).maxCoeff(&largest);
    segment[p] = static_cast<int>(largest);
  }
  return segment;
}

Segmentation numberedByArea(const SurfaceGraph& graph, Segmentation segmentation) {
  const std::vector<int> order = byFallingArea(areasOf(graph, segmentation.labels));
  std::vector<int> number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) number[order[i]] = static_cast<int>(i);
  for (int& label : segmentation.labels) label = number[label];
  for (SegmentNode& node : segmentation.tree)
    if (node.segment >= 0) node.segment = number[node.segment];
  return segmentation;
}

}  // namespace pcl_symmetry
