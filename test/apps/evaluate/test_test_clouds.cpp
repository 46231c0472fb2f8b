#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "apps/support/box_mesh.h"
#include "core/neighbours/diameter.h"
#include "evaluate/clouds/test_clouds.h"
#include "evaluate/references/reference_symmetries.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

const Eigen::Vector3f kHalf(1.0f, 1.5f, 2.0f);  // derived: of a box without equal sides

std::vector<TestCloud> cloudsOf(CloudRow row, TestCloudOptions options = {}) {
  options.rows = {row};
  const TestCloudMaker maker(boxMesh(kHalf), "a/box.off", options);
  std::vector<TestCloud> clouds;
  for (const CloudRecipe& recipe : recipesFor(options)) clouds.push_back(maker.make(recipe));
  return clouds;
}

Eigen::Vector3d inModel(const TestCloud& cloud, const pcl::PointXYZ& point) {
  return cloud.T_cloud_model.inverse() * point.getVector3fMap().cast<double>();
}

/// Distance of a point in the frame of the model from the surface of the box.
double distanceFromBox(const Eigen::Vector3d& x) {
  const Eigen::Vector3d beyond = x.cwiseAbs() - kHalf.cast<double>();
  return std::abs(beyond.maxCoeff() <= 0.0 ? beyond.maxCoeff() : beyond.cwiseMax(0.0).norm());
}

TEST(TestClouds, RowsHaveTheRecipesThatTheyPromise) {
  TestCloudOptions options;
  options.num_views = 2;
  options.noise = {0.0, 0.01};
  const auto numRecipes = [&](CloudRow row) {
    options.rows = {row};
    return recipesFor(options).size();
  };
  EXPECT_EQ(numRecipes(CloudRow::Whole), 1u);
  EXPECT_EQ(numRecipes(CloudRow::Noise), 1u);
  EXPECT_EQ(numRecipes(CloudRow::Scan), 2u);
  EXPECT_EQ(numRecipes(CloudRow::Moved), 2u);
  EXPECT_EQ(numRecipes(CloudRow::Crop), 3u);
  EXPECT_EQ(numRecipes(CloudRow::Sampling), kSamplingPatterns.size());
  options.rows = {CloudRow::Whole, CloudRow::Noise,    CloudRow::Scan,
                  CloudRow::Crop,  CloudRow::Sampling, CloudRow::Moved};
  std::set<std::string> names;
  for (const CloudRecipe& recipe : recipesFor(options)) names.insert(recipe.name);
  EXPECT_EQ(names.size(), 13u) << "names are unique";
}

TEST(TestClouds, AMovedScanIsTheScanWithoutItsViewpoint) {
  TestCloudOptions options;
  options.num_views = 1;
  options.num_points = 1000;
  const TestCloud scan = cloudsOf(CloudRow::Scan, options).front(), moved = cloudsOf(CloudRow::Moved, options).front();
  EXPECT_TRUE(scan.cloud->isOrganized());
  EXPECT_FALSE(moved.cloud->isOrganized());
  EXPECT_EQ(moved.cloud->sensor_origin_.head<3>().norm(), 0.0f);
  EXPECT_EQ(moved.cloud->sensor_orientation_.w(), 1.0f);
  EXPECT_GT((scan.T_cloud_model.matrix() - moved.T_cloud_model.matrix()).norm(), 0.1);
  std::size_t i = 0;
  for (const pcl::PointXYZ& point : *scan.cloud) {
    if (!point.getVector3fMap().allFinite()) continue;
    ASSERT_LT(i, moved.cloud->size());
    EXPECT_LT((inModel(scan, point) - inModel(moved, (*moved.cloud)[i++])).norm(), 1e-4);
  }
  EXPECT_EQ(i, moved.cloud->size());
  // The true view moves along, so that what it shows can still be judged.
  const Eigen::Isometry3d T_model_sensor = scan.T_cloud_model.inverse() * scan.view->T_cloud_sensor;
  EXPECT_LT(
      (moved.T_cloud_model.inverse() * moved.view->T_cloud_sensor * T_model_sensor.inverse()).translation().norm(),
      1e-6);
}

TEST(TestClouds, ACropLosesItsShareBehindAPlane) {
  TestCloudOptions options;
  options.num_points = 1000;
  const std::vector<TestCloud> crops = cloudsOf(CloudRow::Crop, options);
  ASSERT_EQ(crops.size(), 3u);
  EXPECT_EQ(crops[0].cloud->size(), 950u);
  EXPECT_EQ(crops[1].cloud->size(), 800u);
  EXPECT_EQ(crops[2].cloud->size(), 500u);
}

TEST(TestClouds, PatternsLieOnTheMeshAndHaveTheirNumberOfPoints) {
  TestCloudOptions options;
  options.num_points = 2000;
  const std::vector<TestCloud> clouds = cloudsOf(CloudRow::Sampling, options);
  ASSERT_EQ(clouds.size(), kSamplingPatterns.size());
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const bool voxels = kSamplingPatterns[i] == SamplingPattern::Voxel;
    EXPECT_NEAR(static_cast<double>(clouds[i].cloud->size()), 2000.0, voxels ? 60.0 : 0.0)
        << toString(kSamplingPatterns[i]);
    // The mean of the points of a voxel lies off the surface where two faces meet: within half its edge, 0.15 here.
    for (const pcl::PointXYZ& point : *clouds[i].cloud)
      EXPECT_LT(distanceFromBox(inModel(clouds[i], point)), voxels ? 0.1 : 1e-4) << toString(kSamplingPatterns[i]);
  }
}

}  // namespace
