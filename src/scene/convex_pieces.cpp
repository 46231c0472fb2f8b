#include "scene/convex_pieces.h"

#include <pcl/segmentation/lccp_segmentation.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "core/base/lists.h"
#include "scene/scene_parts.h"
#include "scene/scene_rules.h"

namespace pcl_symmetry::detail {

namespace {

/// The piece of each supervoxel, named by one of its supervoxels. Small segments are joined with their largest
/// neighbor, the smallest one first: LCCPSegmentation would join them in the order of their addresses.
std::map<std::uint32_t, std::uint32_t> piecesOf(pcl::LCCPSegmentation<pcl::PointXYZ>& segmentation) {
  std::map<std::uint32_t, std::set<std::uint32_t>> members, neighbors;
  segmentation.getSegmentToSupervoxelMap(members);
  segmentation.getSegmentAdjacencyMap(neighbors);
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(members[a].size(), *members[a].begin()) < std::pair(members[b].size(), *members[b].begin());
  };
  while (true) {
    std::set<std::uint32_t, decltype(before)> small(before);
    for (const auto& [segment, around] : neighbors)
      if (!around.empty() && members[segment].size() <= kScene.fewest) small.insert(segment);
    if (small.empty()) break;
    const std::uint32_t from = *small.begin();
    const std::set<std::uint32_t> around = neighbors[from];
    const std::uint32_t to = *std::max_element(around.begin(), around.end(), before);
    for (const std::uint32_t other : around) {
      neighbors[other].erase(from);
      if (other == to) continue;
      neighbors[other].insert(to);
      neighbors[to].insert(other);
    }
    neighbors.erase(from);
    members[to].merge(members[from]);
    members.erase(from);
  }
  std::map<std::uint32_t, std::uint32_t> pieces;
  for (const auto& [segment, supervoxels] : members)
    for (const std::uint32_t supervoxel : supervoxels) pieces[supervoxel] = *supervoxels.begin();
  return pieces;
}

}  // namespace

std::vector<pcl::Indices> convexPieces(const SymmetryScene::Cloud& scene, const pcl::Indices& cluster,
                                       const Eigen::Vector3d& viewpoint, double spacing, int min_points) {
  const auto voxel = static_cast<float>(kScene.voxel_spacings * spacing);
  const auto supervoxel = static_cast<float>(kScene.supervoxel_voxels * voxel);
  pcl::SupervoxelClustering<pcl::PointXYZ> clustering(voxel, supervoxel);
  clustering.setUseSingleCameraTransform(false);
  // PCL orients normals toward the origin.
  auto points = pcl::make_shared<SymmetryScene::Cloud>(scene, cluster);
  for (pcl::PointXYZ& point : *points) point.getVector3fMap() -= viewpoint.cast<float>();
  clustering.setInputCloud(points);
  clustering.setColorImportance(0.0f);
  std::map<std::uint32_t, pcl::Supervoxel<pcl::PointXYZ>::Ptr> supervoxels;
  clustering.extract(supervoxels);
  if (supervoxels.size() < 2) return {cluster};
  std::multimap<std::uint32_t, std::uint32_t> adjacent;
  clustering.getSupervoxelAdjacency(adjacent);
  pcl::LCCPSegmentation<pcl::PointXYZ> segmentation;
  segmentation.setConcavityToleranceThreshold(kScene.concavity);
  segmentation.setSmoothnessCheck(true, voxel, supervoxel, kScene.smoothness);
  segmentation.setKFactor(kScene.common_neighbors);
  segmentation.setInputSupervoxels(supervoxels, adjacent);
  segmentation.segment();
  const pcl::PointCloud<pcl::PointXYZL>::Ptr labeled = clustering.getLabeledCloud();
  std::map<std::uint32_t, std::uint32_t> piece_of_supervoxel = piecesOf(segmentation);
  std::map<std::uint32_t, pcl::Indices> of_label;
  for (std::size_t i = 0; i < cluster.size(); ++i)
    of_label[piece_of_supervoxel[(*labeled)[i].label]].push_back(cluster[i]);
  std::vector<pcl::Indices> pieces;
  pcl::Indices rest, all;  // points that are in no supervoxel have label 0
  std::vector<std::size_t> piece_of;
  for (auto& [label, piece] : of_label) {
    if (label == 0 || piece.size() < static_cast<std::size_t>(min_points)) {
      rest.insert(rest.end(), piece.begin(), piece.end());
      continue;
    }
    all.insert(all.end(), piece.begin(), piece.end());
    piece_of.resize(all.size(), pieces.size());
    pieces.push_back(std::move(piece));
  }
  if (pieces.size() < 2) return {cluster};
  const std::vector<int> closest = makeFlannSearch(pointsOf(scene, all))->closest(pointsOf(scene, rest));
  for (std::size_t i = 0; i < rest.size(); ++i) pieces[piece_of[closest[i]]].push_back(rest[i]);
  for (pcl::Indices& piece : pieces) std::sort(piece.begin(), piece.end());
  sortDescending(pieces, [](const pcl::Indices& piece) { return piece.size(); });
  return pieces;
}

}  // namespace pcl_symmetry::detail
