/// Principal axes, and solids, sheets and lines, as far as a tolerance tells them apart.
#include "core/geometry/principal_axes.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/base/random.h"
#include "core/geometry/thin_shape.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using namespace test;

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

Points boxOf(const Eigen::Vector3f& size) {
  Points points(3, 1000);
  RandomStream random(1);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    for (int k = 0; k < 3; ++k) points(k, i) = size[k] * static_cast<float>(random.uniform() - 0.5);
  return points;
}

Thinness thinness(const Points& points, double plane_tolerance, double line_tolerance) {
  return thinnessOf(points, principalAxes(points), plane_tolerance, line_tolerance);
}

Thinness thinness(const Points& points, double tolerance) {
  return thinness(points, tolerance, tolerance);
}

TEST(Thinness, IsThatOfTheSizesBeyondTheTolerance) {
  EXPECT_EQ(thinness(boxOf({2.0f, 1.0f, 0.5f}), 0.02), Thinness::Solid);
  EXPECT_EQ(thinness(boxOf({2.0f, 1.0f, 0.03f}), 0.02), Thinness::Sheet);
  EXPECT_EQ(thinness(boxOf({2.0f, 0.02f, 0.02f}), 0.02), Thinness::Line);
  EXPECT_EQ(thinness(boxOf({2.0f, 1.0f, 0.03f}), 0.005), Thinness::Solid) << "another tolerance";
}

TEST(Thinness, ALineHasAToleranceOfItsOwn) {
  const Points rod = boxOf({2.0f, 0.03f, 0.03f});
  EXPECT_EQ(thinness(rod, 0.005, 0.03), Thinness::Line);
  EXPECT_EQ(thinness(rod, 0.005, 0.005), Thinness::Solid);
}

TEST(Thinness, AFewPointsBesideDoNotCount) {
  Points points = boxOf({2.0f, 1.0f, 0.0f});
  points(2, 500) = 0.5f;
  EXPECT_EQ(thinness(points, 0.02), Thinness::Sheet);
}

}  // namespace
}  // namespace pcl_symmetry
