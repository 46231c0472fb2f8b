#include "pcl_symmetry/symmetry_alignment.h"

#include <gtest/gtest.h>
#include <pcl/common/point_tests.h>
#include <pcl/exceptions.h>

#include "clouds.h"
#include "shapes/scans.h"

namespace pcl_symmetry {
namespace {

using test::Sampling;

SymmetryFrame frameOf(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud) {
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setInputCloud(cloud);
  return alignment.compute();
}

pcl::PointCloud<pcl::PointXYZ>::Ptr organizedCloud(const test::Scan& scan) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(scan.width, scan.height);
  for (std::size_t i = 0; i < cloud->size(); ++i)
    (*cloud)[i].getVector3fMap() = scan.pixels.col(static_cast<Eigen::Index>(i));
  cloud->is_dense = false;
  cloud->sensor_origin_.head<3>() = scan.viewpoint.cast<float>();
  return cloud;
}

TEST(SymmetryAlignment, IsSymmetryFrameOfTheFinitePoints) {
  const auto shape = test::moved(test::box(3000, Sampling::Random, 1), test::randomPose(3));
  const SymmetryFrame expected = symmetryFrame(shape.cloud());
  const auto cloud = test::toCloud(shape);
  EXPECT_EQ(frameOf(cloud).T_canonical_input.matrix(), expected.T_canonical_input.matrix());
  EXPECT_EQ(frameOf(test::withHoles(*cloud, 7)).T_canonical_input.matrix(), expected.T_canonical_input.matrix());
}

TEST(SymmetryAlignment, HonoursIndices) {
  const auto box = test::box(3000, Sampling::Random, 1);
  auto cloud = test::toCloud(box);
  const SymmetryFrame expected = frameOf(cloud);
  const auto indices = pcl::make_shared<pcl::Indices>(cloud->size());
  for (std::size_t i = 0; i < indices->size(); ++i) (*indices)[i] = static_cast<pcl::index_t>(i);
  for (int i = 0; i < 500; ++i) cloud->push_back({5.0f, 0.01f * static_cast<float>(i), 2.0f});
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setInputCloud(cloud);
  alignment.setIndices(indices);
  EXPECT_EQ(alignment.compute().T_canonical_input.matrix(), expected.T_canonical_input.matrix());
  EXPECT_EQ(alignment.getUsedIndices(), *indices);
}

TEST(SymmetryAlignment, SeesTheViewpointOfAScan) {
  const test::Scan scan = test::scan(test::blockBox(), {3.5, 4.2, 2.9});
  const auto cloud = organizedCloud(scan);
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setInputCloud(cloud);
  const SymmetryFrame frame = alignment.compute();
  EXPECT_TRUE(alignment.usedViewpoint());
  const double error = frame.center.norm();
  EXPECT_LT(error, 0.1);
  EXPECT_FALSE(alignment.getTiming().empty());

  alignment.setViewpointMode(Viewpoint::Mode::None);
  alignment.compute();
  EXPECT_FALSE(alignment.usedViewpoint());

  const auto loose = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const pcl::PointXYZ& point : *cloud)
    if (pcl::isXYZFinite(point)) loose->push_back(point);
  alignment.setInputCloud(loose);
  alignment.setViewpoint(scan.viewpoint);
  EXPECT_LT(alignment.compute().center.norm(), 0.1);
  EXPECT_TRUE(alignment.usedViewpoint());
}

TEST(SymmetryAlignment, DrawsFromLargeClouds) {
  const auto shape = test::moved(test::box(20'000, Sampling::Random, 2), test::randomPose(5));
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setMaxPoints(4000);
  alignment.setInputCloud(test::toCloud(shape));
  const SymmetryFrame frame = alignment.compute();
  EXPECT_EQ(alignment.getUsedIndices().size(), 4000u);
  EXPECT_LT((frame.center - test::randomPose(5).translation()).norm(), 0.05);
}

TEST(SymmetryAlignment, RefusesWhatHasNoExtent) {
  SymmetryAlignment<pcl::PointXYZ> alignment;
  EXPECT_THROW(alignment.compute(), pcl::BadArgumentException);
  EXPECT_THROW(alignment.setTie(-1.0), pcl::BadArgumentException);
  EXPECT_THROW(alignment.setGridSize(2), pcl::BadArgumentException);
  EXPECT_THROW(alignment.setNumberOfThreads(-1), pcl::BadArgumentException);
  EXPECT_THROW(alignment.setMaxPoints(1), pcl::BadArgumentException);
  alignment.setInputCloud(pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(4, 1, pcl::PointXYZ(NAN, NAN, NAN)));
  EXPECT_THROW(alignment.compute(), pcl::BadArgumentException);
}

}  // namespace
}  // namespace pcl_symmetry
