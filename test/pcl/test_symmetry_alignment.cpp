#include "pcl_symmetry/symmetry_alignment.h"

#include <gtest/gtest.h>

#include "pcl/clouds.h"

namespace pcl_symmetry {
namespace {

using test::Sampling;

SymmetryFrame frameOf(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud) {
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setInputCloud(cloud);
  return alignment.compute();
}

TEST(SymmetryAlignment, IsSymmetryFrameOfTheFinitePoints) {
  const auto shape = test::moved(test::box(3000, Sampling::Random, 1), test::randomPose(3));
  const SymmetryFrame expected = symmetryFrame(shape.cloud());
  const auto cloud = test::toCloud(shape);
  EXPECT_EQ(frameOf(cloud).T_canonical_input.matrix(), expected.T_canonical_input.matrix());
  EXPECT_EQ(frameOf(test::withHoles(*cloud, 7)).T_canonical_input.matrix(), expected.T_canonical_input.matrix());
}

TEST(SymmetryAlignment, SeesTheViewpointOfAScanAndAsksTheSearchMethodForItsRotations) {
  const test::Scan scan = test::scan(test::blockBox(), {3.5, 4.2, 2.9});
  SymmetryAlignment<pcl::PointXYZ> alignment;
  alignment.setInputCloud(test::pictureOf(scan));
  const SymmetryFrame frame = alignment.compute();
  EXPECT_TRUE(alignment.usedViewpoint());
  EXPECT_LT(frame.center.norm(), 0.1);
  EXPECT_FALSE(alignment.getTiming().empty());

  const auto search = pcl::make_shared<test::CountingKdTree>();
  alignment.setSearchMethod(search);
  EXPECT_EQ(alignment.compute().rotations.size(), frame.rotations.size());
  EXPECT_GT(search->num_queries, 1000);

  alignment.setViewpointMode(Viewpoint::Mode::None);
  alignment.compute();
  EXPECT_FALSE(alignment.usedViewpoint());
}

}  // namespace
}  // namespace pcl_symmetry
