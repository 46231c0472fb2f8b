#include "core/geometry/axis_rotations.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace pcl_symmetry {

TEST(AxisRotations, AreTheDifferentRotationsOfTheAxes) {
  const auto& rotations = axisRotations();
  EXPECT_EQ(rotations[0], Eigen::Matrix3i::Identity());
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const Eigen::Matrix3d matrix = rotations[i].cast<double>();
    EXPECT_TRUE(matrix.isUnitary());
    EXPECT_NEAR(matrix.determinant(), 1.0, 1e-12);
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(rotations[i], rotations[j]);
  }
}

}  // namespace pcl_symmetry
