#include "pcl_symmetry/model_coefficients.h"

#include <gtest/gtest.h>

#include <limits>

#include "pcl/clouds.h"

namespace pcl_symmetry {
namespace {

using test::messageOf;

pcl::ModelCoefficients coefficientsOf(const std::vector<float>& values) {
  pcl::ModelCoefficients coefficients;
  coefficients.values = values;
  return coefficients;
}

TEST(ModelCoefficients, PlanesGoThereAndBack) {
  const ReflectionPlane plane(Eigen::Vector3d(1.0, -2.0, 2.0), 6.0);
  const pcl::ModelCoefficients coefficients = toModelCoefficients(plane);
  ASSERT_EQ(coefficients.values.size(), 4u);
  EXPECT_FLOAT_EQ(coefficients.values[0], 1.0f / 3.0f);
  EXPECT_FLOAT_EQ(coefficients.values[3], -2.0f) << "a x + b y + c z + d = 0";
  const ReflectionPlane back = planeFromModelCoefficients(coefficients);
  EXPECT_LT((back.coefficients() - plane.coefficients()).norm(), 1e-6) << "the rounding of float";
  const ReflectionPlane longer = planeFromModelCoefficients(coefficientsOf({2.0f, -4.0f, 4.0f, -12.0f}));
  EXPECT_LT((longer.coefficients() - plane.coefficients()).norm(), 1e-12);
}

TEST(ModelCoefficients, AxesGoThereAndBack) {
  SymmetryAxis axis;
  axis.point = Eigen::Vector3d(1.0, 2.0, 3.0);
  axis.direction = Eigen::Vector3d(0.0, 0.6, -0.8);
  const pcl::ModelCoefficients coefficients = toModelCoefficients(axis);
  EXPECT_EQ(coefficients.values, (std::vector<float>{1.0f, 2.0f, 3.0f, 0.0f, 0.6f, -0.8f}));
  const SymmetryAxis back = axisFromModelCoefficients(coefficients);
  EXPECT_EQ(back.point, axis.point);
  EXPECT_LT((back.direction - axis.direction).norm(), 1e-7);
  EXPECT_NEAR(axisFromModelCoefficients(coefficientsOf({0, 0, 0, 0, 5, 0})).direction.y(), 1.0, 1e-15);
}

TEST(ModelCoefficients, RefuseWhatIsNoPlaneOrLine) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const auto refusedAsPlane = [](const std::vector<float>& values) {
    return messageOf([&] { planeFromModelCoefficients(coefficientsOf(values)); });
  };
  const auto refusedAsAxis = [](const std::vector<float>& values) {
    return messageOf([&] { axisFromModelCoefficients(coefficientsOf(values)); });
  };
  EXPECT_EQ(refusedAsPlane({1, 0, 0}), "number of coefficients = 3, must be 4");
  EXPECT_EQ(refusedAsAxis({1, 0, 0, 1}), "number of coefficients = 4, must be 6");
  EXPECT_NE(refusedAsPlane({1, 0, none, 1}).find("finite"), std::string::npos);
  EXPECT_NE(refusedAsPlane({0, 0, 0, 1}).find("zero"), std::string::npos);
  EXPECT_NE(refusedAsAxis({1, 1, 1, 0, 0, 0}).find("zero"), std::string::npos);
}

}  // namespace
}  // namespace pcl_symmetry
