#include "pcl_symmetry/axial_symmetry_transform.h"

#include <gtest/gtest.h>

#include "pcl/clouds.h"

namespace pcl_symmetry {
namespace {

using test::Sampling;

TEST(AxialSymmetryTransform, FindsTheAxisOfAPrism) {
  AxialSymmetryTransform<pcl::PointXYZ> transform;
  transform.setMapSize(8, 32, 16);
  transform.setOptions({{0, 2, 5}});
  transform.setInputCloud(test::toCloud(test::prism(5, 3000, Sampling::Random, 2)));
  EXPECT_TRUE(transform.getAxes().empty());
  const AxisMap map = transform.compute();
  EXPECT_EQ(map.greatest.size(), 8u * 32u * 16u * 16u);
  EXPECT_EQ(map.folds, (std::vector<int>{0, 2, 5}));
  const std::vector<AxisMaximum> axes = transform.getAxes(3);
  const bool found = std::any_of(axes.begin(), axes.end(), [](const AxisMaximum& maximum) {
    return maximum.fold == 5 && std::abs(maximum.axis.direction().z()) > 0.99 && maximum.value > 0.9;
  });
  EXPECT_TRUE(found);
  // A new cloud forgets the last one.
  transform.setInputCloud(test::toCloud(test::box(1000, Sampling::Random, 2)));
  EXPECT_TRUE(transform.getAxes().empty());
}

}  // namespace
}  // namespace pcl_symmetry
