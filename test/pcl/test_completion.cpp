#include "pcl_symmetry/completion.h"

#include <gtest/gtest.h>
#include <pcl/point_types.h>

#include "pcl/clouds.h"

namespace pcl_symmetry {
namespace {

using namespace test;

TEST(CompleteBySymmetry, AddsReflectedPointsAndSaysWhichTheyAre) {
  const Scan scan = test::scan(blockChair(), {6.0, -3.0, 3.0});
  const auto cloud = pictureOf<pcl::PointNormal>(scan);
  for (pcl::PointNormal& point : *cloud) {
    point.getNormalVector3fMap() = Eigen::Vector3f(0.6f, -0.8f, 0.0f);
    point.curvature = 0.25f;
  }
  const ReflectionPlane middle(Eigen::Vector3d::UnitX(), 0.0);
  const CompletedCloud<pcl::PointNormal> completed = completeBySymmetry(*cloud, middle);
  ASSERT_GT(completed.added.size(), 100u);
  ASSERT_EQ(completed.sources.size(), completed.added.size());
  ASSERT_EQ(completed.cloud.size(), cloud->size() + completed.added.size());
  EXPECT_EQ(completed.cloud.height, 1u);
  EXPECT_EQ(completed.cloud.width, completed.cloud.size());
  for (std::size_t k = 0; k < completed.added.size(); ++k) {
    ASSERT_EQ(static_cast<std::size_t>(completed.added[k]), cloud->size() + k);
    const pcl::PointNormal &added = completed.cloud[completed.added[k]], &source = (*cloud)[completed.sources[k]];
    EXPECT_NEAR(added.x, -source.x, 1e-6f);
    EXPECT_EQ(added.y, source.y);
    EXPECT_EQ(added.z, source.z);
    EXPECT_NEAR(added.normal_x, -0.6f, 1e-6f);
    EXPECT_NEAR(added.normal_y, -0.8f, 1e-6f);
    EXPECT_EQ(added.curvature, 0.25f);
  }
}

TEST(CompleteBySymmetry, ReflectsTheViewpointThatAPointCarries) {
  pcl::PointCloud<pcl::PointWithViewpoint> cloud;
  pcl::PointWithViewpoint point;
  point.x = 1.0f;
  point.y = point.z = 0.0f;
  point.vp_x = 5.0f;
  point.vp_y = 6.0f;
  point.vp_z = 7.0f;
  cloud.push_back(point);
  const auto completed =
      completeBySymmetry(cloud, ReflectionPlane(Eigen::Vector3d::UnitX(), 0.0), {}, {Viewpoint::Mode::None});
  ASSERT_EQ(completed.cloud.size(), 2u);
  EXPECT_EQ(completed.cloud[1].x, -1.0f);
  EXPECT_EQ(completed.cloud[1].vp_x, -5.0f);
  EXPECT_EQ(completed.cloud[1].vp_y, 6.0f);
  EXPECT_TRUE(completeBySymmetry(pcl::PointCloud<pcl::PointXYZ>(), ReflectionPlane()).cloud.empty());
  EXPECT_EQ(completeBySymmetry(pcl::PointCloud<pcl::PointXYZ>(3, 1, pcl::PointXYZ(NAN, 0, 0)), ReflectionPlane())
                .cloud.size(),
            3u);
  CompletionOptions options;
  options.overlap = -1.0;
  EXPECT_THROW(completeBySymmetry(cloud, ReflectionPlane(), options), pcl::BadArgumentException);
}

}  // namespace
}  // namespace pcl_symmetry
