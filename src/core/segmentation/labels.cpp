#include "core/segmentation/labels.h"

#include <algorithm>
#include <map>

#include "core/base/lists.h"
#include "core/geometry/point_samples.h"
#include "core/segmentation/segmentation_rules.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry {

std::vector<double> areasOf(const SurfaceGraph& graph, const std::vector<int>& labels) {
  std::vector<double> areas(1 + static_cast<std::size_t>(*std::max_element(labels.begin(), labels.end())), 0.0);
  for (int i = 0; i < graph.size(); ++i)
    if (labels[i] >= 0) areas[labels[i]] += graph.areas[i];
  return areas;
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
  const std::vector<int> order = descendingOrder(areasOf(graph, segmentation.labels));
  std::vector<int> number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) number[order[i]] = static_cast<int>(i);
  for (int& label : segmentation.labels) label = number[label];
  for (SegmentNode& node : segmentation.tree)
    if (node.segment >= 0) node.segment = number[node.segment];
  return segmentation;
}

namespace {

/// Labels that result from copying one side of a plane to the other.
struct CopiedLabels {
  /// For each element: its own label or, if copied, the number of segments + the label of the segment copied to it.
  std::vector<int> labels;
  double kept = 0.0;  ///< area that stays with the segment that most of its new segment belonged to
};

/// For each segment, whether it lies on both sides of a plane.
std::vector<char> liesAcross(const SurfaceGraph& graph, const std::vector<int>& labels,
                             const std::vector<char>& above) {
  const std::vector<double> areas = areasOf(graph, labels);
  std::vector<double> areas_above(areas.size(), 0.0);
  for (int i = 0; i < graph.size(); ++i)
    if (above[i]) areas_above[labels[i]] += graph.areas[i];
  std::vector<char> across;
  for (std::size_t s = 0; s < areas.size(); ++s)
    across.push_back(std::min(areas_above[s], areas[s] - areas_above[s]) >= kSegmentation.min_across * areas[s]);
  return across;
}

CopiedLabels copySide(bool copy_above, const SurfaceGraph& graph, const std::vector<int>& labels,
                      const std::vector<char>& above, const std::vector<int>& reflected) {
  const std::vector<char> across = liesAcross(graph, labels, above);
  CopiedLabels copied;
  std::map<int, std::map<int, double>> shared;  // shared area, by new and old label
  for (int i = 0; i < graph.size(); ++i) {
    int label = labels[i];
    if ((above[i] != 0) != copy_above) {
      const int other = labels[reflected[i]];
      label = across[other] ? other : other + static_cast<int>(across.size());
    }
    copied.labels.push_back(label);
    shared[label][labels[i]] += graph.areas[i];
  }
  for (const auto& [label, areas] : shared) {
    double most = 0.0;
    for (const auto& [old_label, area] : areas) most = std::max(most, area);
    copied.kept += most;
  }
  return copied;
}

}  // namespace

std::vector<int> reflectedElements(const SurfaceGraph& graph, const ReflectionPlane& plane) {
  return makeFlannSearch(graph.centers)->closest(reflectedPoints(graph.centers, plane));
}

std::vector<std::vector<int>> segmentImages(const PartEvidence& evidence, const std::vector<int>& labels,
                                            int num_segments) {
  std::vector<int> of_patch(evidence.patches.areas.size(), 0);
  for (std::size_t i = 0; i < labels.size(); ++i) of_patch[evidence.patches.of_element[i]] = labels[i];
  std::vector<std::vector<int>> images;
  for (const std::vector<int>& image : evidence.images) {
    Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(num_segments, num_segments);
    for (std::size_t p = 0; p < image.size(); ++p) shared(of_patch[image[p]], of_patch[p]) += evidence.patches.areas[p];
    std::vector<int>& of_segment = images.emplace_back();
    for (int s = 0; s < num_segments; ++s) {
      Eigen::Index most = s;
      shared.col(s).maxCoeff(&most);
      of_segment.push_back(static_cast<int>(most));
    }
  }
  return images;
}

std::vector<int> symmetrizedLabels(const SurfaceGraph& graph, const std::vector<int>& labels,
                                   const ReflectionPlane& plane, const std::vector<int>& reflected) {
  std::vector<char> above;
  for (int i = 0; i < graph.size(); ++i)
    above.push_back(plane.signedDistance(graph.centers.col(i).cast<double>()) > 0.0);
  const CopiedLabels below_copied = copySide(false, graph, labels, above, reflected);
  const CopiedLabels above_copied = copySide(true, graph, labels, above, reflected);
  return renumbered((below_copied.kept >= above_copied.kept ? below_copied : above_copied).labels);
}

}  // namespace pcl_symmetry
