#include "core/geometry/directions.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/constants.h"

using namespace pcl_symmetry;

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
