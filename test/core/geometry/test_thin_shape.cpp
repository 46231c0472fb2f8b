/// Solids, sheets and lines, as far as a tolerance tells them apart.
#include "core/geometry/thin_shape.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace {

using namespace pcl_symmetry;

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
