#include "core/base/check.h"

#include <gtest/gtest.h>

using namespace pcl_symmetry;

TEST(Check, NamesFieldValueAndRule) {
  check(true, "sigma", 1.0, "> 0");
  try {
    check(false, "sigma", -1.5, "> 0");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "sigma = -1.5, must be > 0");
  }
  checkNumThreads(0);
  EXPECT_THROW(checkNumThreads(-1), std::invalid_argument);
}
