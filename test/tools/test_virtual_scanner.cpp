#include "scanner/virtual_scanner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pcl/pcl_meshes.h"

namespace {

using namespace pcl_symmetry::apps;

using pcl_symmetry::test::boxMesh;

TEST(VirtualScanner, TakesNoLargerPictureThanAllowed) {
  VirtualScannerOptions options;
  options.num_points = 100'000;
  options.max_resolution = 100;
  const VirtualScan scan = VirtualScanner(boxMesh({0.5f, 0.8f, 1.2f}, {10, -20, 5})).scan({1, 1, 1}, options);
  EXPECT_EQ(scan.cloud->width, 100u);
  EXPECT_LT(scan.num_points, 10'000);
}

TEST(VirtualScanner, RefusesWhatItCannotScan) {
  EXPECT_THROW(VirtualScanner{pcl::PolygonMesh()}, std::invalid_argument);
  EXPECT_THROW(VirtualScanner{boxMesh({0, 0, 0})}, std::invalid_argument);
  EXPECT_THROW(VirtualScanner{boxMesh({1, 1, NAN})}, std::invalid_argument);
}

/// The mean of uniformly distributed rotation matrices is zero; each entry has variance 1/3.
TEST(RandomPose, IsUniform) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  const int n = 3000;
  for (int seed = 0; seed < n; ++seed) {
    const Eigen::Isometry3d pose = randomPose(static_cast<std::uint64_t>(seed), 2.0);
    EXPECT_TRUE((pose.linear() * pose.linear().transpose()).isIdentity(1e-12));
    EXPECT_LE(pose.translation().cwiseAbs().maxCoeff(), 2.0);
    mean += pose.linear() / n;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 5 * std::sqrt(1.0 / 3 / n));
}

}  // namespace
