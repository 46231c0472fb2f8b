#include "scene/object_feet.h"

#include <pcl/kdtree/kdtree_flann.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/median.h"
#include "scene/scene_rules.h"

namespace pcl_symmetry::detail {

namespace {

constexpr double kDeviationPerMedian = 1.4826;  // of absolute values, normal distribution

struct Box {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector3f high = -low;

  Box(const SymmetryScene::Cloud& scene, const pcl::Indices& points, double margin) {
    for (const pcl::index_t i : points) {
      low = low.cwiseMin(scene[i].getVector3fMap());
      high = high.cwiseMax(scene[i].getVector3fMap());
    }
    low.array() -= static_cast<float>(margin);
    high.array() += static_cast<float>(margin);
  }

  bool contains(const Eigen::Vector3f& x) const {
    return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
  }
};

double heightOver(const SupportingPlane& support, const pcl::PointXYZ& point) {
  return support.coefficients.dot(point.getVector3fMap().cast<double>().homogeneous().eval());
}

/// The cluster that is nearest to each point of the supports.
class NearestClusters {
public:
  explicit NearestClusters(std::size_t scene_size)
      : sq_distances_(scene_size, std::numeric_limits<float>::max()), owners_(scene_size, -1) {}

  void offer(pcl::index_t point, int cluster, float sq_distance) {
    const auto i = static_cast<std::size_t>(point);
    if (!(sq_distance < sq_distances_[i])) return;
    sq_distances_[i] = sq_distance;
    owners_[i] = cluster;
  }

  /// \return -1: none
  int of(pcl::index_t point) const { return owners_[static_cast<std::size_t>(point)]; }

private:
  std::vector<float> sq_distances_;
  std::vector<int> owners_;
};

/// Offers a cluster the points of the supports that may be its feet.
void offerFeet(const SymmetryScene::Cloud::ConstPtr& scene, const std::vector<SupportingPlane>& supports,
               const pcl::Indices& cluster, int number, double spacing, double distance, NearestClusters& nearest) {
  const Box near(*scene, cluster, distance);
  pcl::KdTreeFLANN<pcl::PointXYZ> tree(false);
  tree.setInputCloud(scene, pcl::make_shared<pcl::Indices>(cluster));
  pcl::Indices closest(1);
  std::vector<float> sq_distance(1);
  for (const SupportingPlane& support : supports) {
    const double least = riseOfNoise(*scene, support, cluster, spacing, distance);
    for (const pcl::index_t i : support.indices) {
      if (!near.contains((*scene)[i].getVector3fMap()) || heightOver(support, (*scene)[i]) <= least) continue;
      if (tree.nearestKSearch((*scene)[i], 1, closest, sq_distance) < 1) continue;
      if (sq_distance[0] <= distance * distance) nearest.offer(i, number, sq_distance[0]);
    }
  }
}

}  // namespace

double riseOfNoise(const SymmetryScene::Cloud& scene, const SupportingPlane& support, const pcl::Indices& cluster,
                   double spacing, double distance) {
  const Box around(scene, cluster, kScene.around * distance);
  std::vector<double> heights;
  for (const pcl::index_t i : support.indices)
    if (around.contains(scene[i].getVector3fMap())) heights.push_back(std::abs(heightOver(support, scene[i])));
  if (heights.size() < kScene.least_around) return std::numeric_limits<double>::infinity();
  return std::max(kScene.rises_at_least * spacing, kScene.rises * kDeviationPerMedian * median(std::move(heights)));
}

void returnFeet(const SymmetryScene::Cloud::ConstPtr& scene, std::vector<SupportingPlane>& supports,
                std::vector<pcl::Indices>& clusters, double spacing, double distance) {
  NearestClusters nearest(scene->size());
  for (std::size_t k = 0; k < clusters.size(); ++k)
    offerFeet(scene, supports, clusters[k], static_cast<int>(k), spacing, distance, nearest);
  for (SupportingPlane& support : supports) {
    pcl::Indices rest;
    for (const pcl::index_t i : support.indices) {
      const int owner = nearest.of(i);
      (owner < 0 ? rest : clusters[static_cast<std::size_t>(owner)]).push_back(i);
    }
    support.indices = std::move(rest);
  }
  for (pcl::Indices& cluster : clusters) std::sort(cluster.begin(), cluster.end());
}

}  // namespace pcl_symmetry::detail
