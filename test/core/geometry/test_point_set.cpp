#include "pcl_symmetry/core/point_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/diameter.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(BoundingBall, HoldsEveryPointAndIsNearlyTheSmallest) {
  for (std::uint64_t pose = 0; pose < 5; ++pose) {
    // The corners of a box lie on its smallest ball.
    Eigen::Matrix3Xd corners(3, 8);
    for (int s = 0; s < 8; ++s)
      corners.col(s) = Eigen::Vector3d(s & 1 ? 1 : -1, s & 2 ? 0.7 : -0.7, s & 4 ? 0.45 : -0.45);
    const Points points = moved({corners, {}}, randomPose(pose)).cloud();
    const BoundingBall ball = boundingBall(points);
    const double smallest = Eigen::Vector3d(1.0, 0.7, 0.45).norm();
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      EXPECT_LE((points.col(i).cast<double>() - ball.center).norm(), ball.radius * (1.0 + 1e-12));
    EXPECT_GE(ball.radius, smallest * (1.0 - 1e-6));
    EXPECT_LE(ball.radius, smallest * 1.02);
    EXPECT_LT((ball.center - randomPose(pose).translation()).norm(), 0.05);
  }
}

TEST(BoundingBall, OfOnePointHasNoRadius) {
  const BoundingBall ball = boundingBall(Points::Constant(3, 4, 2.5f));
  EXPECT_EQ(ball.radius, 0.0);
  EXPECT_EQ(ball.center, Eigen::Vector3d::Constant(2.5));
  EXPECT_EQ(boundingBall(Points(3, 0)).radius, 0.0);
}

TEST(BoundingBall, OfPointsThatAreNotFiniteHasNoCenter) {
  for (const float coordinate : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN(),
                                 std::numeric_limits<float>::infinity()}) {
    Points points = Points::Random(3, 4);
    points(1, 2) = coordinate;
    EXPECT_FALSE(boundingBall(points).center.allFinite()) << coordinate;
  }
}

TEST(CenterOfMass, IsTheMeanFarFromTheOrigin) {
  Points points(3, 3);
  points << 1e6f, 1e6f + 1.0f, 1e6f + 2.0f, -3.0f, 0.0f, 3.0f, 5.0f, 5.0f, 5.0f;
  EXPECT_LT((centerOfMass(points) - Eigen::Vector3d(1e6 + 1.0, 0.0, 5.0)).norm(), 1e-9);
  EXPECT_EQ(centerOfMass(Points(3, 0)), Eigen::Vector3d::Zero());
}

TEST(NormalizePoints, CentersAndScales) {
  Points points(3, 2);
  points << 3.0f, 5.0f, 0.0f, 2.0f, -1.0f, 1.0f;
  const Points expected = (Points(3, 2) << 1.0f, 2.0f, -0.5f, 0.5f, -1.0f, 0.0f).finished();
  EXPECT_EQ(normalizePoints(points, {1.0, 1.0, 1.0}, 2.0), expected);
}

double diameterByAllPairs(const Points& points) {
  double sq_greatest = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      sq_greatest = std::max(sq_greatest, (points.col(i).cast<double>() - points.col(j).cast<double>()).squaredNorm());
  return std::sqrt(sq_greatest);
}

TEST(Diameter, IsThatOfAllPairs) {
  for (const Shape& shape : {sphere(2000, 1), cylinder(2000, 2), box(2000, Sampling::Random, 3),
                             scaleneTetrahedron(2000, 4), cube(2000, Sampling::Mirrored, 5)}) {
    for (const double scale : {1e-3, 1.0, 1e6}) {
      const Points points = scaled(moved(shape, randomPose(6)), scale).cloud();
      EXPECT_EQ(diameter(points), diameterByAllPairs(points));
    }
  }
}

TEST(Diameter, OfFewOrEqualPoints) {
  EXPECT_EQ(diameter(Points(3, 0)), 0.0);
  EXPECT_EQ(diameter(Points::Ones(3, 1)), 0.0);
  EXPECT_EQ(diameter(Points::Ones(3, 100)), 0.0);
  Points two(3, 2);
  two << 0, 3, 0, 0, 0, 4;
  EXPECT_EQ(diameter(two), 5.0);
  const Points line = Eigen::Vector3f(1.0f, 2.0f, 2.0f) * Eigen::RowVectorXf::LinSpaced(1001, -1.0f, 1.0f);
  EXPECT_EQ(diameter(line), 6.0);
}

TEST(FarthestPair, IsTheDiameterOfMostShapesAndNeverMuchLess) {
  for (const Shape& shape : {cylinder(2000, 2), box(2000, Sampling::Random, 3), scaleneTetrahedron(2000, 4)}) {
    const Points points = moved(shape, randomPose(6)).cloud();
    EXPECT_NEAR(farthestPair(points), diameter(points), 1e-2 * diameter(points));
  }
  const Points round = sphere(2000, 1).cloud();
  EXPECT_LE(farthestPair(round), diameter(round));
  EXPECT_GE(farthestPair(round), diameter(round) / std::sqrt(3.0));
  EXPECT_EQ(farthestPair(Points(3, 0)), 0.0);
  EXPECT_EQ(farthestPair(Points::Ones(3, 100)), 0.0);
}

}  // namespace
