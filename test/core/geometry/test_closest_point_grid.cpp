/// One look-up tells nearly the closest point.
#include "core/geometry/closest_point_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// The sweeps as they are defined: cell after cell, each asks its predecessors along x, y and z.
std::vector<int> sweptOneByOne(const Points& points, int n) {
  const BoundingBall ball = boundingBall(points);
  const auto cell_size = static_cast<float>(2.0 * 1.25 * ball.radius / n);
  const Eigen::Vector3f origin = (ball.center.array() - 1.25 * ball.radius).matrix().cast<float>();
  std::vector<int> nearest(static_cast<std::size_t>(n * n * n), -1);
  std::vector<float> sq_distances(nearest.size(), std::numeric_limits<float>::infinity());
  const auto offer = [&](int x, int y, int z, int point) {
    const Eigen::Vector3f center =
        origin + cell_size * Eigen::Vector3f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                                             static_cast<float>(z) + 0.5f);
    const auto cell = static_cast<std::size_t>((z * n + y) * n + x);
    const float sq_distance = point < 0 ? sq_distances[cell] : (points.col(point) - center).squaredNorm();
    if (!(sq_distance < sq_distances[cell])) return;
    sq_distances[cell] = sq_distance;
    nearest[cell] = point;
  };
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3i cell = ((points.col(i) - origin) / cell_size).array().cast<int>();
    offer(cell.x(), cell.y(), cell.z(), static_cast<int>(i));
  }
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1 ? -1 : 1, dy = corner & 2 ? -1 : 1, dz = corner & 4 ? -1 : 1;
    const auto at = [&](int x, int y, int z) { return nearest[static_cast<std::size_t>((z * n + y) * n + x)]; };
    for (int k = 0, z = dz > 0 ? 0 : n - 1; k < n; ++k, z += dz)
      for (int j = 0, y = dy > 0 ? 0 : n - 1; j < n; ++j, y += dy)
        for (int i = 0, x = dx > 0 ? 0 : n - 1; i < n; ++i, x += dx) {
          if (i > 0) offer(x, y, z, at(x - dx, y, z));
          if (j > 0) offer(x, y, z, at(x, y - dy, z));
          if (k > 0) offer(x, y, z, at(x, y, z - dz));
        }
  }
  return nearest;
}

TEST(ClosestPointGrid, WholeRowsFindWhatCellsFindOneByOne) {
  Points lattice(3, 7 * 7 * 7);  // centers of cells are equally far from several of its points
  for (int i = 0; i < lattice.cols(); ++i)
    lattice.col(i) = Eigen::Array3i(i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3).cast<float>().matrix();
  for (const Points& points : {asymmetricBlob(500, 1).cloud(), lattice}) {
    for (const int n : {2, 7, 24}) {
      const ClosestPointGrid grid(points, n);
      const std::vector<int> expected = sweptOneByOne(points, n);
      const BoundingBall ball = boundingBall(points);
      for (std::size_t cell = 0; cell < expected.size(); ++cell) {
        const auto i = static_cast<int>(cell);
        const Eigen::Array3d place = Eigen::Array3i(i % n, i / n % n, i / n / n).cast<double>() + 0.5;
        const Eigen::Vector3d x = ball.center.array() + 1.25 * ball.radius * (2.0 / n * place - 1.0);
        EXPECT_EQ(grid.closest(x.cast<float>()), expected[cell]) << n << ", cell " << cell;
      }
    }
  }
}

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
