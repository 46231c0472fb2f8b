#include "pcl_symmetry/symmetry_segmentation.h"

#include <gtest/gtest.h>

#include <limits>

#include "pcl/clouds.h"
#include "pcl/pcl_meshes.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "shapes/meshes.h"

namespace pcl_symmetry {
namespace {

class SymmetrySegmentationTest : public testing::Test {
protected:
  const test::Mesh dumbbell_ = test::dumbbell();
  const pcl::PolygonMesh::Ptr mesh_ =
      pcl::make_shared<pcl::PolygonMesh>(test::toMesh(dumbbell_.vertices, dumbbell_.polygons));
  SymmetrySegmentation<pcl::PointXYZ> segmentation_;
  std::vector<pcl::PointIndices> segments_;
};

TEST_F(SymmetrySegmentationTest, EveryFaceOfAMeshIsInOneSegment) {
  segmentation_.setInputMesh(mesh_);
  segmentation_.setNumberOfParts(3);
  segmentation_.segment(segments_);
  ASSERT_EQ(segments_.size(), 3u);
  ASSERT_EQ(segmentation_.getLabels().size(), mesh_->polygons.size());
  std::size_t num_members = 0;
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    num_members += segments_[s].indices.size();
    for (const pcl::index_t i : segments_[s].indices) EXPECT_EQ(segmentation_.getLabels()[i], static_cast<int>(s));
  }
  EXPECT_EQ(num_members, mesh_->polygons.size());
  EXPECT_FALSE(segmentation_.getTree().empty());
}

TEST_F(SymmetrySegmentationTest, CloudsHonorIndicesAndLeaveOutWhatIsNotFinite) {
  const auto cloud = sampleMesh(*mesh_, 3000);
  (*cloud)[7].x = std::numeric_limits<float>::quiet_NaN();
  auto indices = pcl::make_shared<pcl::Indices>();
  for (pcl::index_t i = 0; i < 2000; ++i) indices->push_back(i);
  segmentation_.setInputCloud(cloud);
  segmentation_.setIndices(indices);
  segmentation_.setNumberOfParts(2);
  segmentation_.segment(segments_);
  ASSERT_EQ(segments_.size(), 2u);
  ASSERT_EQ(segmentation_.getLabels().size(), cloud->size());
  EXPECT_EQ(segmentation_.getLabels()[7], -1);
  EXPECT_EQ(segmentation_.getLabels()[2500], -1);
  EXPECT_EQ(segments_[0].indices.size() + segments_[1].indices.size(), 1999u);
}

TEST_F(SymmetrySegmentationTest, SplittingAsksTheSearchMethod) {
  SegmentationOptions options;
  options.method = SegmentationMethod::Splitting;
  options.splitting.depth = 1;
  segmentation_.setOptions(options);
  segmentation_.setInputCloud(sampleMesh(*mesh_, 2000));
  segmentation_.segment(segments_);
  const std::vector<int> labels = segmentation_.getLabels();
  const auto search = pcl::make_shared<test::CountingKdTree>();
  segmentation_.setSearchMethod(search);
  segmentation_.segment(segments_);
  EXPECT_EQ(segmentation_.getLabels(), labels);
  EXPECT_GT(search->num_queries, 2 * 2000) << "neighbors of all points, labels, and Iterative Symmetric Points";
}

TEST_F(SymmetrySegmentationTest, SaysWhatIsWrongWithAMesh) {
  segmentation_.setInputMesh(pcl::make_shared<pcl::PolygonMesh>());
  segmentation_.segment(segments_);
  EXPECT_TRUE(segments_.empty());
  EXPECT_EQ(segmentation_.getReason(), "mesh: no polygon has an area");
}

TEST_F(SymmetrySegmentationTest, AUsedObjectIsAsGoodAsANewOne) {
  const auto cloud = sampleMesh(*mesh_, 1000);
  SymmetrySegmentation<pcl::PointXYZ> fresh;
  for (auto* segmentation : {&segmentation_, &fresh}) segmentation->setNumberOfParts(3);
  segmentation_.setInputMesh(mesh_);
  segmentation_.segment(segments_);
  segmentation_.setInputCloud(cloud);
  EXPECT_TRUE(segmentation_.getLabels().empty());
  segmentation_.extract(segments_);
  std::vector<pcl::PointIndices> expected;
  fresh.setInputCloud(cloud);
  fresh.segment(expected);
  EXPECT_EQ(segmentation_.getLabels(), fresh.getLabels()) << "the cloud was set last";
  ASSERT_EQ(segments_.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(segments_[i].indices, expected[i].indices);
}

}  // namespace
}  // namespace pcl_symmetry
