#include "core/segmentation/fragments.h"

#include <algorithm>
#include <limits>
#include <map>

namespace pcl_symmetry {

namespace {

/// Segments with their areas and the lengths of their common borders, input units.
class SmallSegments {
public:
  SmallSegments(const SurfaceGraph& graph, std::vector<int> labels) : graph_(graph), labels_(std::move(labels)) {
    for (int i = 0; i < graph.size(); ++i) areas_[labels_[i]] += graph.areas[i];
    for (const SurfaceGraph::Edge& edge : graph.edges) {
      const int a = labels_[edge.from], b = labels_[edge.to];
      if (a == b) continue;
      contacts_[a][b] += edge.length;
      contacts_[b][a] += edge.length;
    }
  }

  int size() const { return static_cast<int>(areas_.size()); }
  double area(int segment) const { return areas_.at(segment); }

  int smallest() const {
    return std::min_element(areas_.begin(), areas_.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  /// The segment that a small one belongs to.
  int hostOf(int segment) const {
    const auto found = contacts_.find(segment);
    if (found == contacts_.end() || found->second.empty()) return closestTo(segment);
    return std::max_element(found->second.begin(), found->second.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  void join(int host, int segment) {
    areas_[host] += areas_[segment];
    areas_.erase(segment);
    std::replace(labels_.begin(), labels_.end(), segment, host);
    for (const auto& [other, length] : contacts_[segment]) {
      contacts_[other].erase(segment);
      if (other == host) continue;
      contacts_[other][host] += length;
      contacts_[host][other] += length;
    }
    contacts_.erase(segment);
  }

  std::vector<int> labels() const {
    std::map<int, int> number;
    for (const auto& [segment, area] : areas_) number.emplace(segment, static_cast<int>(number.size()));
    std::vector<int> labels;
    for (const int label : labels_) labels.push_back(number.at(label));
    return labels;
  }

private:
  /// The segment with the element that is closest to the mean of a segment.
  int closestTo(int segment) const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    int count = 0;
    for (int i = 0; i < graph_.size(); ++i) {
      if (labels_[i] != segment) continue;
      mean += graph_.centers.col(i).cast<double>();
      ++count;
    }
    const Eigen::Vector3f middle = (mean / count).cast<float>();
    int closest = segment;
    float least = std::numeric_limits<float>::infinity();
    for (int i = 0; i < graph_.size(); ++i) {
      const float sq_distance = (graph_.centers.col(i) - middle).squaredNorm();
      if (labels_[i] == segment || sq_distance >= least) continue;
      closest = labels_[i];
      least = sq_distance;
    }
    return closest;
  }

  const SurfaceGraph& graph_;
  std::vector<int> labels_;
  std::map<int, double> areas_;                    ///< by segment
  std::map<int, std::map<int, double>> contacts_;  ///< by both segments
};

}  // namespace

std::vector<int> joinSmallSegments(const SurfaceGraph& graph, std::vector<int> labels, double least_area,
                                   int most_segments) {
  SmallSegments segments(graph, std::move(labels));
  while (segments.size() > 1) {
    const int smallest = segments.smallest();
    if (segments.area(smallest) >= least_area && segments.size() <= most_segments) break;
    segments.join(segments.hostOf(smallest), smallest);
  }
  return segments.labels();
}

}  // namespace pcl_symmetry
