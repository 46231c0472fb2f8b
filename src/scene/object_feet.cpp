#include "scene/object_feet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/statistics.h"
#include "scene/scene_rules.h"

namespace pcl_symmetry::detail {

namespace {

Eigen::AlignedBox3f boxAround(const SymmetryScene::Cloud& scene, const pcl::Indices& points, double margin) {
  Eigen::AlignedBox3f box;
  for (const pcl::index_t i : points) box.extend(Eigen::Vector3f(scene[i].getVector3fMap()));
  box.min().array() -= static_cast<float>(margin);
  box.max().array() += static_cast<float>(margin);
  return box;
}

/// For each point of a scene the squared distance from the nearest cluster, and its number; -1: none.
using NearestClusters = std::vector<std::pair<float, int>>;

/// Offers a cluster the points of the supports that may be its feet.
void offerFeet(const SymmetryScene::Cloud& scene, const std::vector<SupportingPlane>& supports,
               const pcl::Indices& cluster, int number, const SceneDistances& distances, NearestClusters& nearest) {
  const Eigen::AlignedBox3f near = boxAround(scene, cluster, distances.cluster);
  pcl::Indices risen;
  for (const SupportingPlane& support : supports) {
    const double least = riseOfNoise(scene, support, cluster, distances);
    for (const pcl::index_t i : support.indices)
      if (near.contains(Eigen::Vector3f(scene[i].getVector3fMap())) &&
          heightOver(support.coefficients, scene[i]) > least)
        risen.push_back(i);
  }
  const std::vector<float> sq_distances = sqDistancesFrom(pointsOf(scene, cluster), pointsOf(scene, risen));
  for (std::size_t i = 0; i < risen.size(); ++i)
    if (sq_distances[i] <= distances.cluster * distances.cluster && sq_distances[i] < nearest[risen[i]].first)
      nearest[risen[i]] = {sq_distances[i], number};
}

}  // namespace

double riseOfNoise(const SymmetryScene::Cloud& scene, const SupportingPlane& support, const pcl::Indices& cluster,
                   const SceneDistances& distances) {
  const Eigen::AlignedBox3f around = boxAround(scene, cluster, kScene.around * distances.cluster);
  std::vector<double> heights;
  for (const pcl::index_t i : support.indices)
    if (around.contains(Eigen::Vector3f(scene[i].getVector3fMap())))
      heights.push_back(std::abs(heightOver(support.coefficients, scene[i])));
  if (heights.size() < kScene.min_around) return std::numeric_limits<double>::infinity();
  return std::max(kScene.rises_at_least * distances.spacing,
                  kScene.rises * kDeviationPerMedian * median(std::move(heights)));
}

void returnFeet(const SymmetryScene::Cloud& scene, std::vector<SupportingPlane>& supports,
                std::vector<pcl::Indices>& clusters, const SceneDistances& distances) {
  NearestClusters nearest(scene.size(), {std::numeric_limits<float>::max(), -1});
  for (std::size_t k = 0; k < clusters.size(); ++k)
    offerFeet(scene, supports, clusters[k], static_cast<int>(k), distances, nearest);
  for (SupportingPlane& support : supports) {
    pcl::Indices rest;
    for (const pcl::index_t i : support.indices) {
      const int owner = nearest[i].second;
      (owner < 0 ? rest : clusters[owner]).push_back(i);
    }
    support.indices = std::move(rest);
  }
  for (pcl::Indices& cluster : clusters) std::sort(cluster.begin(), cluster.end());
}

}  // namespace pcl_symmetry::detail
