#include "pcl_symmetry/model_coefficients.h"

#include <gtest/gtest.h>

namespace pcl_symmetry {
namespace {

TEST(ModelCoefficients, AreThoseOfPCL) {
  const pcl::ModelCoefficients plane = toModelCoefficients(ReflectionPlane(Eigen::Vector3d(1.0, -2.0, 2.0), 6.0));
  ASSERT_EQ(plane.values.size(), 4u);
  EXPECT_FLOAT_EQ(plane.values[0], 1.0f / 3.0f);
  EXPECT_FLOAT_EQ(plane.values[3], -2.0f) << "a x + b y + c z + d = 0";
  SymmetryAxis axis;
  axis.point = Eigen::Vector3d(1.0, 2.0, 3.0);
  axis.direction = Eigen::Vector3d(0.0, 0.6, -0.8);
  EXPECT_EQ(toModelCoefficients(axis).values, (std::vector<float>{1.0f, 2.0f, 3.0f, 0.0f, 0.6f, -0.8f}));
}

}  // namespace
}  // namespace pcl_symmetry
