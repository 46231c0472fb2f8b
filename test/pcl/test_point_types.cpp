/// Descriptors as PCL points: search trees see all their values.
#include "pcl_symmetry/point_types.h"

#include <gtest/gtest.h>
#include <pcl/kdtree/impl/kdtree_flann.hpp>

#include <algorithm>
#include <iterator>
#include <vector>

namespace {

using namespace pcl_symmetry;

template <typename PointT, std::size_t Size>
void expectAllValues(float (PointT::*values)[Size]) {
  static_assert(PointT::descriptorSize() == static_cast<int>(Size));
  const pcl::DefaultPointRepresentation<PointT> representation;
  ASSERT_EQ(representation.getNumberOfDimensions(), PointT::descriptorSize());
  PointT point;
  for (std::size_t i = 0; i < Size; ++i) (point.*values)[i] = static_cast<float>(i % 1000);
  std::vector<float> copied(Size);
  representation.copyToFloatArray(point, copied.data());
  EXPECT_TRUE(std::equal(copied.begin(), copied.end(), std::begin(point.*values)));
}

TEST(PointRepresentation, HoldsAllValuesOfADescriptor) {
  expectAllValues(&PRSTSignature32768::prst);
  expectAllValues(&PRSDSignature1024::prsd);
  expectAllValues(&GEDTSignature32768::gedt);
  expectAllValues(&ShapeSignature20736::signature);
}

TEST(PointRepresentation, SearchTreesCompareAllValues) {
  auto cloud = pcl::make_shared<pcl::PointCloud<PRSTSignature32768>>();
  cloud->resize(4);
  for (std::size_t i = 0; i < cloud->size(); ++i) (*cloud)[i].prst[32767 - i] = 1.0f;  // equal in the first values
  pcl::KdTreeFLANN<PRSTSignature32768> tree;
  tree.setInputCloud(cloud);
  for (int i = 0; i < 4; ++i) {
    pcl::Indices indices;
    std::vector<float> sq_distances;
    ASSERT_EQ(tree.nearestKSearch((*cloud)[static_cast<std::size_t>(i)], 2, indices, sq_distances), 2);
    EXPECT_EQ(indices[0], i);
    EXPECT_EQ(sq_distances[0], 0.0f);
    EXPECT_EQ(sq_distances[1], 2.0f);
  }
}

}  // namespace
