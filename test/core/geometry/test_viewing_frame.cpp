#include "core/geometry/viewing_frame.h"

#include <gtest/gtest.h>

#include "core/geometry/directions.h"

using namespace pcl_symmetry;

TEST(ViewingFrame, IsARotationThatLooksForward) {
  for (const Eigen::Vector3d& forward : evenDirections(50)) {
    const Eigen::Matrix3d R = viewingFrame(forward);
    EXPECT_TRUE((R * R.transpose()).isIdentity(1e-14));
    EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
    EXPECT_TRUE((R * forward).isApprox(Eigen::Vector3d::UnitZ(), 1e-14));
  }
}
