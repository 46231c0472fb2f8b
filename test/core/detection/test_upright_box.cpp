/// The middle plane of a vehicle in the rings of a LiDAR.
#include "core/detection/standing_object.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace pcl_symmetry {
namespace {

const Eigen::Vector3d kFrom(-6.0, -9.0, 1.5);  // the scanner sees the sides at low x and at low y

/// Rows of points on two sides of a box of 4 x 2 x 1, turned about z.
Points twoSides(double turn) {
  Points points(3, 0);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto add = [&](const Eigen::Vector3d& x) {
    points.conservativeResize(3, points.cols() + 1);
    points.col(points.cols() - 1) = (R * x).cast<float>();
  };
  for (int ring = 0; ring < 6; ++ring) {
    const double z = 0.1 + 0.16 * ring;
    for (int i = 0; i <= 40; ++i) add({-2.0 + 0.1 * i, -1.0, z});
    for (int i = 1; i <= 20; ++i) add({-2.0, -1.0 + 0.1 * i, z});
  }
  return points;
}

TEST(MiddlePlaneOfBox, IsAlongTheLongerSideAndTurnsWithThePoints) {
  for (const double turn : {0.0, 0.4, 1.3, 2.9}) {
    const Eigen::AngleAxisd R(turn, Eigen::Vector3d::UnitZ());
    const auto plane = middlePlaneOfBox(twoSides(turn), {0.0, 0.0, 2.0}, R * kFrom);
    ASSERT_TRUE(plane);
    EXPECT_LT(std::acos(std::abs(plane->plane.normal().dot(R * Eigen::Vector3d::UnitY()))), 0.01) << turn;
    EXPECT_LT(std::abs(plane->plane.signedDistance(Eigen::Vector3d::Zero())), 0.05) << turn;
    EXPECT_NEAR(plane->confidence, 0.94, 0.06) << "straight sides, and nothing in free space: " << turn;
  }
}

TEST(MiddlePlaneOfBox, DoubtsWhatHasNoStraightSides) {
  RandomStream random(3);
  Points cloud(3, 400);
  for (Eigen::Index i = 0; i < cloud.cols(); ++i)
    cloud.col(i) << static_cast<float>(4.0 * random.uniform()), static_cast<float>(2.0 * random.uniform()),
        static_cast<float>(random.uniform());
  const auto plane = middlePlaneOfBox(cloud, Eigen::Vector3d::UnitZ(), kFrom);
  ASSERT_TRUE(plane);
  EXPECT_LT(plane->confidence, 0.5);
}

}  // namespace
}  // namespace pcl_symmetry
