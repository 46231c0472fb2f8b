/// Descriptors as PCL points: search trees see all their values.
#include "pcl_symmetry/point_types.h"

#include <gtest/gtest.h>
#include <pcl/point_representation.h>

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

}  // namespace
