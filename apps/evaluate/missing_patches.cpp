#include "missing_patches.h"

#include <pcl/common/point_tests.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pcl_symmetry/core/random.h"

namespace pcl_symmetry::apps {

void removePatches(pcl::PointCloud<pcl::PointXYZ>& cloud, double share, std::uint64_t seed) {
  constexpr double kPatchShare = 0.04;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (pcl::isXYZFinite(cloud[i])) left.push_back(i);
  const auto num_finite = static_cast<double>(left.size());
  auto num_to_go = static_cast<std::size_t>(std::lround(share * num_finite));
  RandomStream random(seed);
  while (num_to_go > 0 && !left.empty()) {
    const std::size_t size =
        std::min({num_to_go, left.size(), static_cast<std::size_t>(std::ceil(kPatchShare * num_finite))});
    const Eigen::Vector3f middle = cloud[left[random.below(left.size())]].getVector3fMap();
    const auto distance = [&](std::size_t i) { return (cloud[i].getVector3fMap() - middle).squaredNorm(); };
    std::sort(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
      return std::make_pair(distance(a), a) < std::make_pair(distance(b), b);
    });
    for (std::size_t k = 0; k < size; ++k) cloud[left[k]].getVector3fMap().setConstant(kNone);
    left.erase(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(size));
    num_to_go -= size;
    cloud.is_dense = false;
  }
}

}  // namespace pcl_symmetry::apps
