/// The greatest distance between two points, against all pairs.
#include "core/geometry/diameter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
