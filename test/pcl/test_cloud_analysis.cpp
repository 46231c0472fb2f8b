#include "pcl_symmetry/impl/cloud_analysis.hpp"

#include <gtest/gtest.h>
#include <pcl/point_types.h>

#include "pcl/clouds.h"
#include "pcl/error_message.h"

namespace pcl_symmetry {
namespace {

/// Returns the points that it uses.
class Copy : public ScanAnalysis<pcl::PointXYZ> {
public:
  Copy() : ScanAnalysis<pcl::PointXYZ>("Copy", 100) {}
  Points compute() { return selectInput(1); }
};

pcl::PointCloud<pcl::PointXYZ>::Ptr grid(int size) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (int i = 0; i < size; ++i) cloud->emplace_back(0.1f * (i % 7), 0.1f * (i / 7), 0.01f * (i % 3));
  return cloud;
}

TEST(CloudAnalysis, SelectsFinitePointsOfTheIndices) {
  const auto cloud = grid(60);
  (*cloud)[3].x = std::numeric_limits<float>::infinity();
  auto indices = pcl::make_shared<pcl::Indices>();
  for (pcl::index_t i = 0; i < 40; ++i) indices->push_back(i);
  Copy copy;
  copy.setInputCloud(cloud);
  copy.setIndices(indices);
  const Points points = copy.compute();
  ASSERT_EQ(points.cols(), 39);
  ASSERT_EQ(copy.getUsedIndices().size(), 39u);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    EXPECT_EQ(points.col(i), (*cloud)[copy.getUsedIndices()[i]].getVector3fMap());
  EXPECT_EQ(copy.getReason(), "");
}

TEST(CloudAnalysis, DrawsOnePointOfEachRun) {
  Copy copy;
  copy.setMaxPoints(50);
  copy.setInputCloud(grid(500));
  ASSERT_EQ(copy.compute().cols(), 50);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(copy.getUsedIndices()[i] / 10, static_cast<int>(i));
}

TEST(CloudAnalysis, SaysWhyDataHoldNoAnswer) {
  for (const auto& [name, cloud] : test::cloudsWithoutAnswer()) {
    Copy copy;
    copy.setInputCloud(cloud);
    EXPECT_EQ(copy.compute().cols(), 0) << name;
    EXPECT_EQ(copy.getReason().rfind("input cloud: ", 0), 0u) << name << ": " << copy.getReason();
    EXPECT_TRUE(copy.getUsedIndices().empty()) << name;
  }
}

TEST(CloudAnalysis, ForgetsTheLastCloud) {
  Copy copy;
  copy.setInputCloud(grid(60));
  copy.compute();
  copy.setInputCloud(nullptr);
  EXPECT_TRUE(copy.getUsedIndices().empty());
  copy.compute();
  EXPECT_EQ(copy.getReason(), "input cloud: not set");
  copy.setInputCloud(grid(60));
  EXPECT_EQ(copy.getReason(), "");
  EXPECT_EQ(copy.compute().cols(), 60);
}

TEST(CloudAnalysis, RefusesWrongParameters) {
  Copy copy;
  EXPECT_EQ(test::messageOf([&] { copy.setMaxPoints(1); }), "max_points = 1, must be >= 2");
  copy.setInputCloud(grid(60));
  copy.setIndices(pcl::make_shared<pcl::Indices>(1, 60));
  EXPECT_EQ(test::messageOf([&] { copy.compute(); }), "indices[0] = 60, must be in [0, 60)");
}

TEST(ScanAnalysis, KeepsTheViewpoint) {
  Copy copy;
  EXPECT_EQ(copy.getViewpoint().mode, Viewpoint::Mode::Auto);
  copy.setViewpoint(Eigen::Vector3d(1, 2, 3));
  copy.setInputCloud(grid(60));
  EXPECT_EQ(copy.getViewpoint().mode, Viewpoint::Mode::Given);
  EXPECT_EQ(copy.getViewpoint().position, Eigen::Vector3d(1, 2, 3));
  copy.setViewpointMode(Viewpoint::Mode::None);
  EXPECT_EQ(copy.getViewpoint().mode, Viewpoint::Mode::None);
  EXPECT_FALSE(copy.usedViewpoint());
}

}  // namespace
}  // namespace pcl_symmetry
