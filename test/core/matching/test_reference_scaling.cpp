#include "core/matching/reference_scaling.h"

#include <gtest/gtest.h>

#include <limits>

namespace pcl_symmetry {

TEST(TypicalDistance, IsTheMeanOfTheNearest) {
  constexpr float kItself = std::numeric_limits<float>::infinity();
  EXPECT_FLOAT_EQ(typicalDistance({4.0f, 1.0f, kItself, 2.0f, 9.0f}, 3), (1.0f + 2.0f + 4.0f) / 3.0f);
  EXPECT_FLOAT_EQ(typicalDistance({4.0f, kItself, 1.0f}, 10), 2.5f);
  EXPECT_FLOAT_EQ(typicalDistance({kItself}), 1.0f);
  EXPECT_GT(typicalDistance({0.0f, 0.0f}), 0.0f);
}

}  // namespace pcl_symmetry
