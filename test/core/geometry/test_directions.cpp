/// Directions, and rotations that look along them.
#include "core/geometry/directions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "core/base/constants.h"
#include "core/geometry/axis_rotations.h"
#include "core/geometry/viewing_frame.h"

namespace pcl_symmetry {
namespace {

TEST(GoldenFraction, IsTheFractionalPartOfMultiples) {
  EXPECT_EQ(goldenFraction(0), 0.0);
  EXPECT_DOUBLE_EQ(kGoldenSection, 0.5 * (std::sqrt(5.0) - 1.0));
  for (int k = 1; k < 1000; ++k) EXPECT_NEAR(goldenFraction(k), std::fmod(k * kGoldenSection, 1.0), 1e-12);
}

TEST(SpiralDirection, CutsTheHalfSphereIntoRingsOfEqualArea) {
  EXPECT_DOUBLE_EQ(kGoldenAngle, 2.0 * kPi * (1.0 - kGoldenSection));
  constexpr int kCount = 50;
  for (int k = 0; k < kCount; ++k) {
    const Eigen::Vector3d n = spiralDirection(k, kCount, 0.7);
    EXPECT_NEAR(n.norm(), 1.0, 1e-15);
    EXPECT_DOUBLE_EQ(n.z(), (k + 0.5) / kCount);
    EXPECT_NEAR(std::atan2(n.y(), n.x()), 0.7, 1e-12);
  }
}

TEST(EvenDirections, LieAboutTheOriginAndApartFromEachOther) {
  EXPECT_THROW(evenDirections(0), std::invalid_argument);
  const auto single = evenDirections(1);
  ASSERT_EQ(single.size(), 1u);
  EXPECT_NEAR(single[0].norm(), 1.0, 1e-15);
  for (const int count : {10, 200}) {
    const auto directions = evenDirections(count);
    ASSERT_EQ(static_cast<int>(directions.size()), count);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < directions.size(); ++i) {
      EXPECT_NEAR(directions[i].norm(), 1.0, 1e-15);
      if (i > 0) {
        EXPECT_LT(directions[i].z(), directions[i - 1].z());
      }
      sum += directions[i];
      // A square lattice of this density has its points sqrt(4 pi / count) apart; the spiral keeps three quarters.
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_GT((directions[i] - directions[j]).norm(), 0.75 * std::sqrt(4.0 * kPi / count));
    }
    EXPECT_LT(sum.norm() / count, 0.05);
  }
}

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

TEST(ViewingFrame, IsARotationThatLooksForward) {
  for (const Eigen::Vector3d& forward : evenDirections(50)) {
    const Eigen::Matrix3d R = viewingFrame(forward);
    EXPECT_TRUE((R * R.transpose()).isIdentity(1e-14));
    EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
    EXPECT_TRUE((R * forward).isApprox(Eigen::Vector3d::UnitZ(), 1e-14));
  }
}

}  // namespace
}  // namespace pcl_symmetry
