#include "core/segmentation/merging/mirrored_labels.h"

#include <algorithm>
#include <map>

#include "pcl_symmetry/core/neighbours/closest_point_search.h"

namespace pcl_symmetry {

namespace {

/// chosen: share of the surface that a plane maps onto itself if labels agree across it. Lower values force symmetry on
/// shapes with parts that have no counterpart; with 1 sampling alone would break the agreement.
constexpr double kGlobalShare = 0.95;
/// chosen: share of a region on the smaller side of a plane that it lies across. At half, a region that the patches
/// carry a little over the plane counts as lying across it; at twice, only a region that the plane nearly halves does.
constexpr double kLeastAcross = 0.2;

/// Patches and regions on both sides of a plane.
class Sides {
public:
  Sides(const Regions& regions, const PartEvidence& evidence, const ReflectionPlane& plane)
      : regions_(regions), area_above_(static_cast<std::size_t>(evidence.size()), 0.0) {
    for (int p = 0; p < evidence.size(); ++p) {
      above_.push_back(plane.signedDistance(evidence.patches.centers.col(p).cast<double>()) > 0.0);
      if (above_[p]) area_above_[regions.ofPatches()[p]] += evidence.patches.areas[p];
    }
  }

  bool isAbove(int patch) const { return above_[patch]; }
  bool liesAcross(int region) const {
    const double area = regions_.area(region);
    return std::min(area_above_[region], area - area_above_[region]) >= kLeastAcross * area;
  }

private:
  const Regions& regions_;
  std::vector<char> above_;
  std::vector<double> area_above_;  ///< of each region, share of the surface
};

/// Groups of patches that result from copying one side of a plane to the other.
struct MirroredGroups {
  /// Of each patch: the number of its region, or the number of patches + the number of the region that is copied to it.
  std::vector<int> group;
  double changed = 0.0;  ///< share of the surface whose region changes
};

MirroredGroups copySide(bool copy_above, const Regions& regions, const PartEvidence& evidence, const Sides& sides,
                        std::size_t plane) {
  const std::vector<int>& image = evidence.images[plane];
  const int size = evidence.size();
  MirroredGroups groups;
  for (int p = 0; p < size; ++p) {
    const int own = regions.ofPatches()[p], other = regions.ofPatches()[image[p]];
    int group = own;
    if (sides.isAbove(p) != copy_above) {
      const bool is_own_image = sides.liesAcross(other);
      group = is_own_image ? other : other + size;
      const bool agrees = is_own_image ? own == other : regions.imageOf(other, plane) == own;
      if (!agrees) groups.changed += evidence.patches.areas[p];
    }
    groups.group.push_back(group);
  }
  return groups;
}

/// One region per group of patches.
Regions regionsOf(const std::vector<int>& group, const PartEvidence& evidence) {
  Regions regions(evidence);
  std::map<int, int> first;
  for (int p = 0; p < evidence.size(); ++p) {
    const auto [entry, is_new] = first.emplace(group[p], p);
    if (!is_new) regions.merge(entry->second, p);
  }
  return regions;
}

/// The segment at the reflection of each listed element.
std::vector<int> labelsAtReflections(const SurfaceGraph& graph, const std::vector<int>& labels,
                                     const std::vector<int>& elements, const ReflectionPlane& plane) {
  Points reflected(3, static_cast<Eigen::Index>(elements.size()));
  for (std::size_t k = 0; k < elements.size(); ++k)
    reflected.col(static_cast<Eigen::Index>(k)) =
        plane.reflect(graph.centers.col(elements[k]).cast<double>()).cast<float>();
  std::vector<int> closest;
  std::vector<float> sq_distances;
  makeTreeSearch(graph.centers)->search(reflected, 1, closest, sq_distances);
  for (int& element : closest) element = labels[element];
  return closest;
}

}  // namespace

std::optional<GlobalPlane> globalPlane(const PartEvidence& evidence) {
  std::size_t index = 0;  // among the planes with images
  for (const PartPlane& plane : evidence.planes) {
    if (plane.share < kMappedShare) continue;
    if (plane.share >= kGlobalShare) return GlobalPlane{plane.plane, index};
    ++index;
  }
  return std::nullopt;
}

Regions mirroredRegions(const Regions& regions, const PartEvidence& evidence, const GlobalPlane& global) {
  const Sides sides(regions, evidence, global.plane);
  const MirroredGroups below_copied = copySide(false, regions, evidence, sides, global.index);
  const MirroredGroups above_copied = copySide(true, regions, evidence, sides, global.index);
  return regionsOf((below_copied.changed <= above_copied.changed ? below_copied : above_copied).group, evidence);
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

std::vector<int> mirroredLabels(const SurfaceGraph& graph, const std::vector<int>& labels,
                                const std::vector<int>& image, const ReflectionPlane& plane) {
  for (std::size_t s = 0; s < image.size(); ++s)
    if (image[image[s]] != static_cast<int>(s)) return labels;
  std::vector<int> below;
  for (int i = 0; i < graph.size(); ++i)
    if (plane.signedDistance(graph.centers.col(i).cast<double>()) < 0.0) below.push_back(i);
  const std::vector<int> across = labelsAtReflections(graph, labels, below, plane);
  std::vector<int> copied = labels;
  for (std::size_t k = 0; k < below.size(); ++k) copied[below[k]] = image[across[k]];
  std::vector<char> used(image.size(), 0);
  for (const int label : copied) used[label] = 1;
  return std::find(used.begin(), used.end(), 0) == used.end() ? copied : labels;
}

}  // namespace pcl_symmetry
