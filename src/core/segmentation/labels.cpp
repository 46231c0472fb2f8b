#include "core/segmentation/labels.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

std::vector<double> areasOf(const SurfaceGraph& graph, const std::vector<int>& labels) {
  std::vector<double> areas(1 + static_cast<std::size_t>(*std::max_element(labels.begin(), labels.end())), 0.0);
  for (int i = 0; i < graph.size(); ++i)
    if (labels[i] >= 0) areas[labels[i]] += graph.areas[i];
  return areas;
}

std::vector<int> byFallingArea(const std::vector<double>& areas) {
  std::vector<int> order(areas.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return areas[a] > areas[b]; });
  return order;
}

std::vector<int> renumbered(std::vector<int> labels) {
  std::map<int, int> number;
  for (int& label : labels) label = number.emplace(label, static_cast<int>(number.size())).first->second;
  return labels;
}

std::vector<int> filledFromClosest(const SurfaceGraph& graph, std::vector<int> labels) {
  std::vector<int> reached, missed;
  for (int i = 0; i < graph.size(); ++i) (labels[i] >= 0 ? reached : missed).push_back(i);
  if (missed.empty()) return labels;
  const std::vector<int> closest =
      makeFlannSearch(graph.centers(Eigen::all, reached))->closest(graph.centers(Eigen::all, missed));
  for (std::size_t k = 0; k < missed.size(); ++k) labels[missed[k]] = labels[reached[closest[k]]];
  return labels;
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
