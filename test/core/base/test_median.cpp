#include "core/base/median.h"

#include <gtest/gtest.h>

using pcl_symmetry::median;

TEST(Median, IsTheUpperOne) {
  EXPECT_EQ(median(std::vector<float>{2.5f}), 2.5f);
  EXPECT_EQ(median(std::vector<int>{3, 1, 2}), 2);
  EXPECT_EQ(median(std::vector<int>{4, 1, 3, 2}), 3);
  EXPECT_EQ(median(std::vector<double>{7.0, 7.0, 7.0, 0.0}), 7.0);
}
