#include "pcl_symmetry/symmetrization.h"

#include <gtest/gtest.h>
#include <pcl/point_types.h>

#include <cmath>
#include <limits>

#include "pcl/clouds.h"
#include "pcl/pcl_meshes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

const ReflectionPlane kPlane(Eigen::Vector3d::UnitX(), 0.0);

TEST(Symmetrize, ACloudKeepsItsFieldsAndItsReflections) {
  pcl::PointCloud<pcl::PointNormal> cloud = *toCloud<pcl::PointNormal>(box(5000, Sampling::Random, 1));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud[i].curvature = static_cast<float>(i);
    cloud[i].getNormalVector3fMap() = Eigen::Vector3f::UnitX();
  }
  cloud[7].x = std::numeric_limits<float>::quiet_NaN();
  const SymmetrizedCloud<pcl::PointNormal> result = symmetrize(cloud, kPlane, SymmetrizedHalf::Left);
  const std::size_t half = result.cloud.size() / 2;
  ASSERT_EQ(result.cloud.size(), 2 * half);
  EXPECT_GT(half, 1000u);
  for (std::size_t i = 0; i < half; ++i) {
    const pcl::PointNormal &kept = result.cloud[i], &reflected = result.cloud[half + i];
    EXPECT_LT(kept.x, 0.0f);
    EXPECT_EQ(reflected.x, -kept.x);
    EXPECT_EQ(reflected.y, kept.y);
    EXPECT_EQ(reflected.normal_x, -1.0f);
    EXPECT_EQ(reflected.curvature, kept.curvature);
    EXPECT_EQ(static_cast<float>(result.sources[half + i]), kept.curvature);
  }
  EXPECT_TRUE(std::isnan(result.asymmetry[7]));
  EXPECT_TRUE(symmetrize(pcl::PointCloud<pcl::PointXYZ>(), kPlane).cloud.empty());
}

TEST(Symmetrize, AMeshKeepsItsPolygons) {
  pcl::PolygonMesh mesh = boxMesh();
  pcl::PointCloud<pcl::PointXYZ> corners;
  pcl::fromPCLPointCloud2(mesh.cloud, corners);
  for (pcl::PointXYZ& corner : corners)
    if (corner.x > 0.0f) corner.x = 1.1f;
  pcl::toPCLPointCloud2(corners, mesh.cloud);
  const SymmetrizedMesh result = symmetrize(mesh, kPlane);
  ASSERT_EQ(result.mesh.polygons.size(), 6u);
  pcl::PointCloud<pcl::PointXYZ> moved;
  pcl::fromPCLPointCloud2(result.mesh.cloud, moved);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(std::abs(moved[i].x), 1.05f, 1e-5f);
  EXPECT_LT(result.deviation, 1e-5);
  mesh.polygons.clear();
  EXPECT_NE(messageOf([&] { symmetrize(mesh, kPlane); }).find("extent of the mesh"), std::string::npos);
}

TEST(ReflectedCorrespondences, AreThoseOfPCL) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  const float none = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [x, y] : {std::pair{none, 0.0f}, {1.0f, 0.0f}, {-1.001f, 0.0f}, {2.0f, 1.0f}})
    cloud.emplace_back(x, y, 0.0f);
  const pcl::Correspondences pairs = reflectedCorrespondences(cloud, kPlane, 0.01);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].index_query, 1);
  EXPECT_EQ(pairs[0].index_match, 2);
  EXPECT_NEAR(pairs[0].distance, 1e-6f, 1e-8f) << "squared";
  EXPECT_NE(messageOf([&] { reflectedCorrespondences(cloud, kPlane, -1.0); }).find("max_distance"), std::string::npos);
}

}  // namespace
