#include "core/geometry/principal_axes.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(PrincipalAxes, AreThoseOfTheBox) {
  // Mirrored samples have no covariance between the box's axes beyond rounding. Variance along x of a surface sample
  // falls with the half extents.
  for (std::uint64_t pose = 0; pose < 3; ++pose) {
    const Eigen::Isometry3d motion = randomPose(pose);
    const PrincipalAxes axes = principalAxes(moved(box(4000, Sampling::Mirrored, 1), motion).cloud());
    EXPECT_LT((axes.center - motion.translation()).norm(), 1e-6);
    EXPECT_NEAR(axes.axes.determinant(), 1.0, 1e-12);
    EXPECT_LT((axes.axes.transpose() * axes.axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(axes.axes.col(i).dot(motion.linear().col(i))), 1.0, 1e-10) << i;
    EXPECT_GT(axes.variances[0], axes.variances[1]);
    EXPECT_GT(axes.variances[1], axes.variances[2]);
  }
}

TEST(PrincipalAxes, VariancesAreThoseOfTheDefinition) {
  const Points points = (Points(3, 4) << 2, -2, 0, 0, 0, 0, 1, -1, 3, 3, 3, 3).finished();
  const PrincipalAxes axes = principalAxes(points);
  EXPECT_LT((axes.center - Eigen::Vector3d(0.0, 0.0, 3.0)).norm(), 1e-15);
  EXPECT_LT((axes.variances - Eigen::Vector3d(2.0, 0.5, 0.0)).norm(), 1e-14);
}

TEST(PrincipalAxes, PlanesLieAcrossThemThroughTheCenter) {
  const PrincipalAxes axes = principalAxes(asymmetricBlob(500, 1).cloud());
  const auto planes = principalPlanes(axes);
  ASSERT_EQ(planes.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::abs(planes[i].normal().dot(axes.axes.col(i))), 1.0, 1e-14);
    EXPECT_NEAR(planes[i].signedDistance(axes.center), 0.0, 1e-14);
  }
  EXPECT_THROW(principalAxes(Points(3, 0)), std::invalid_argument);
}

}  // namespace
