#include "core/base/k_means.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/random.h"

namespace pcl_symmetry {
namespace {

/// Three clouds of features around (0, 0), (10, 0) and (0, 10), one after the other.
Eigen::MatrixXf threeClouds(int size_of_each) {
  RandomStream random(3);
  Eigen::MatrixXf features(2, 3 * size_of_each);
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    const Eigen::Index cloud = i / size_of_each;
    features(0, i) = static_cast<float>(random.uniform() + (cloud == 1 ? 10.0 : 0.0));
    features(1, i) = static_cast<float>(random.uniform() + (cloud == 2 ? 10.0 : 0.0));
  }
  return features;
}

TEST(KMeans, FindsCloudsThatLieApart) {
  const int size = 50;
  const Clusters clusters = kMeans(threeClouds(size), std::vector<float>(3 * size, 1.0f), 3);
  ASSERT_EQ(clusters.centers.cols(), 3);
  std::set<int> seen;
  for (int cloud = 0; cloud < 3; ++cloud) {
    const int label = clusters.labels[cloud * size];
    seen.insert(label);
    for (int i = 0; i < size; ++i) EXPECT_EQ(clusters.labels[cloud * size + i], label);
  }
  EXPECT_EQ(seen.size(), 3u);
}

TEST(KMeans, FeaturesWithoutWeightDoNotMoveTheCenters) {
  Eigen::MatrixXf features(1, 4);
  features << 0.0f, 1.0f, 10.0f, 1000.0f;
  const Clusters clusters = kMeans(features, {1.0f, 1.0f, 1.0f, 0.0f}, 2);
  std::multiset<float> centers(clusters.centers.data(), clusters.centers.data() + clusters.centers.size());
  EXPECT_EQ(centers, (std::multiset<float>{0.5f, 10.0f}));
}

TEST(KMeans, GivesFewerClustersThanAskedForWhereFeaturesAreEqual) {
  const Clusters clusters = kMeans(Eigen::MatrixXf::Ones(3, 5), std::vector<float>(5, 1.0f), 2);
  EXPECT_EQ(clusters.centers.cols(), 1);
  EXPECT_EQ(clusters.labels, std::vector<int>(5, 0));
  EXPECT_EQ(clusters.sq_error, 0.0);
}

}  // namespace
}  // namespace pcl_symmetry
