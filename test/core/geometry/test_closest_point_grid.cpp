/// One look-up tells nearly the closest point.
#include "core/geometry/closest_point_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(ClosestPointGrid, IsAsExactAsItsCells) {
  const Points points = asymmetricBlob(2000, 1).cloud();
  const ClosestPointGrid grid(points, 32);
  const double cell = 2.0 * 1.25 * boundingBall(points).radius / 32;
  RandomStream random(3);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f x(1.5 * symmetric(random), 1.5 * symmetric(random), 1.5 * symmetric(random));
    const float least = std::sqrt((points.colwise() - x).colwise().squaredNorm().minCoeff());
    const float found = (points.col(grid.closest(x)) - x).norm();
    // x and its cell's center are half a diagonal apart at most; what the sweeps miss is far less than a cell.
    EXPECT_LE(found, least + 2.0 * 0.5 * std::sqrt(3.0) * cell + 0.1 * cell);
  }
}

TEST(ClosestPointGrid, AnswersFarOutsideAndForOnePoint) {
  const Points one = Points::Constant(3, 1, 2.0f);
  EXPECT_EQ(ClosestPointGrid(one).closest({1e6f, -1e6f, 0.0f}), 0);
  Points two(3, 2);
  two << -1, 1, 0, 0, 0, 0;
  EXPECT_EQ(ClosestPointGrid(two).closest({-50.0f, 3.0f, 3.0f}), 0);
  EXPECT_EQ(ClosestPointGrid(two).closest({50.0f, 3.0f, 3.0f}), 1);
  EXPECT_THROW(ClosestPointGrid(Points(3, 0)), std::invalid_argument);
}

}  // namespace
