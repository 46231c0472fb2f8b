#include "evaluate/segmentation/patches.h"

#include <pcl/common/point_tests.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"

namespace pcl_symmetry::apps {

void removePatches(pcl::PointCloud<pcl::PointXYZ>& cloud, double share, int num_patches, std::uint64_t seed) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (pcl::isXYZFinite(cloud[i])) left.push_back(i);
  const auto size = static_cast<std::size_t>(share * static_cast<double>(left.size()) / num_patches);
  RandomStream random(seed);
  for (int patch = 0; patch < num_patches && size > 0; ++patch) {
    const Eigen::Vector3f middle = cloud[left[random.below(left.size())]].getVector3fMap();
    std::vector<std::pair<float, std::size_t>> order;
    for (const std::size_t i : left) order.emplace_back((cloud[i].getVector3fMap() - middle).squaredNorm(), i);
    std::sort(order.begin(), order.end());
    left.clear();
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k < size) {
        cloud[order[k].second].getVector3fMap().setConstant(std::numeric_limits<float>::quiet_NaN());
      } else {
        left.push_back(order[k].second);
      }
    }
  }
  cloud.is_dense = false;
}

}  // namespace pcl_symmetry::apps
