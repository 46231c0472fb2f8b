#include "core/segmentation/patches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

namespace pcl_symmetry {

Patches measuredPatches(const SurfaceGraph& graph, std::vector<int> of_element) {
  Patches patches;
  patches.of_element = std::move(of_element);
  const std::vector<int>& patch = patches.of_element;
  const int size = *std::max_element(patch.begin(), patch.end()) + 1;
  const double whole = graph.area();
  patches.areas.assign(static_cast<std::size_t>(size), 0.0);
  Eigen::Matrix3Xd centers = Eigen::Matrix3Xd::Zero(3, size), normals = centers;
  for (int i = 0; i < graph.size(); ++i) {
    const double area = graph.areas[i] / whole;
    patches.areas[patch[i]] += area;
    centers.col(patch[i]) += area * graph.centers.col(i).cast<double>();
    normals.col(patch[i]) += area * graph.normals.col(i).cast<double>();
  }
  for (int p = 0; p < size; ++p)
    if (patches.areas[p] > 0.0) centers.col(p) /= patches.areas[p];
  patches.centers = centers.cast<float>();
  for (int p = 0; p < size; ++p) normals.col(p) = normals.col(p).stableNormalized();
  patches.normals = normals.cast<float>();
  return patches;
}

std::vector<PatchBorder> patchBorders(const SurfaceGraph& graph, const Patches& patches) {
  std::map<std::pair<int, int>, PatchBorder> borders;
  for (const SurfaceGraph::Edge& edge : graph.edges) {
    const auto ends = std::minmax(patches.of_element[edge.from], patches.of_element[edge.to]);
    if (ends.first == ends.second) continue;
    PatchBorder& border = borders.insert({ends, {ends.first, ends.second, 0.0, 0.0, 0.0}}).first->second;
    border.length += edge.length;
    border.edge_concavity += static_cast<double>(edge.length) * edge.concavity;
  }
  std::vector<PatchBorder> result;
  for (auto& [ends, border] : borders) {
    if (border.length > 0.0) border.edge_concavity /= border.length;
    const Eigen::Vector3f step = patches.centers.col(border.to) - patches.centers.col(border.from);
    const Eigen::Vector3f turn = patches.normals.col(border.from) - patches.normals.col(border.to);
    border.patch_concavity = turn.dot(step.stableNormalized());
    result.push_back(border);
  }
  return result;
}

}  // namespace pcl_symmetry
