#include "pcl_symmetry/core/line_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using namespace test;

TEST(LineGrid, FindsTheBinOfEveryBinCenterAndItsOtherForm) {
  const LineGrid grid(12, 10, {0.3, -0.2}, 1.5);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const ReflectionLine line = grid.line(grid.bin(i));
    EXPECT_EQ(grid.index(*grid.find(line)), i);
    EXPECT_EQ(grid.index(*grid.find(ReflectionLine(line.theta() + kPi, -line.offset()))), i);
  }
  EXPECT_FALSE(grid.find(ReflectionLine(0.0, 2.0)));
}

TEST(LineGrid, SeamLeadsToTheSameLinesTurned) {
  const LineGrid grid(12, 10, {0.0, 0.0}, 1.5);
  const auto to = grid.step({0, 3}, -1, 0);
  ASSERT_TRUE(to);
  EXPECT_EQ(to->theta, 11);
  EXPECT_EQ(to->radius, 6);
  EXPECT_NEAR(grid.line({0, 3}).angleTo(grid.line(*to)), grid.thetaStep(), 1e-12);
  EXPECT_FALSE(grid.step({4, 9}, 0, 1));
}

TEST(LineGrid, RefusesBadParameters) {
  EXPECT_THROW(LineGrid(0, 10, {0.0, 0.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(LineGrid(10, 4097, {0.0, 0.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(LineGrid(10, 10, {0.0, std::nan("")}, 1.0), std::invalid_argument);
  EXPECT_THROW(LineGrid(10, 10, {0.0, 0.0}, 0.0), std::invalid_argument);
}

TEST(LineMap, StrongestIsTheFirstOfTheGreatest) {
  LineMap map;
  EXPECT_TRUE(map.empty());
  EXPECT_EQ(map.strongest(), 0u);
  map.values = {0.2f, 0.9f, 0.9f};
  EXPECT_EQ(map.strongest(), 1u);
  EXPECT_EQ(map[0], 0.2f);
}

}  // namespace
}  // namespace pcl_symmetry
