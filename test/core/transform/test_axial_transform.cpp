/// The transform of axes and of centers against its definition, and its properties.
#include "pcl_symmetry/core/axial_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/constants.h"
#include "core/transform/sampled_transform.h"
#include "shapes/complaint.h"
#include "shapes/scans.h"
#include "shapes/threads.h"
#include "shapes/turning_shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

GaussianEdt edtOf(const Points& points, int num_cells = 32) {
  GaussianEdtOptions options;
  options.num_cells = num_cells;
  return GaussianEdt(points, options);
}

/// Sum over the cells of f(x) g(x) / |f|^2, where g is at what the motion of a transform makes of x: the definition, on
/// the grid.
template <typename Moved>
double correlation(const GaussianEdt& edt, const Moved& g) {
  double sum = 0.0;
  for (std::size_t i = 0; i < edt.values().size(); ++i)
    if (edt.values()[i] > 1e-4f) sum += edt.values()[i] * g(edt.cellCenter(i));
  return sum / edt.sqNorm();
}

/// The mean over the turns about an axis of f(x) g(turned x).
template <typename Function>
double fullSum(const GaussianEdt& edt, const Line3d& axis, int fold, const Function& g) {
  const int num_turns = fold > 0 ? fold - 1 : 90;  // any angle: every 4 degrees
  double sum = 0.0;
  for (int k = 1; k <= num_turns; ++k) {
    const Eigen::AngleAxisd turn(2.0 * kPi * k / (fold > 0 ? fold : num_turns), axis.direction());
    sum += correlation(
        edt, [&](const Eigen::Vector3d& x) { return g(Eigen::Vector3d(axis.origin() + turn * (x - axis.origin()))); });
  }
  return sum / num_turns;
}

TEST(AxisGrid, IndicesAndAxesGoBothWays) {
  const AxisGrid grid(6, 12, 8, {1.0, -2.0, 0.5}, 1.5);
  EXPECT_EQ(grid.size(), 6u * 12u * 64u);
  for (std::size_t i = 0; i < grid.size(); i += 7) {
    const AxisGrid::Bin bin = grid.bin(i);
    EXPECT_EQ(grid.index(bin), i);
    const Line3d axis = grid.axis(bin);
    EXPECT_NEAR(axis.direction().dot(axis.origin() - grid.center()), 0.0, 1e-12);
  }
  EXPECT_THROW(AxisGrid(6, 7, 8, Eigen::Vector3d::Zero(), 1.0), std::invalid_argument);
  EXPECT_THROW(AxisGrid(6, 8, 8, Eigen::Vector3d::Zero(), 0.0), std::invalid_argument);
  EXPECT_THROW(AxisGrid(1024, 1024, 1024, Eigen::Vector3d::Zero(), 1.0), std::invalid_argument);
}

TEST(AxialTransform, IsWithinOnePerCentOfTheFullSum) {
  AxialTransformOptions options;
  options.folds = {0, 2, 3, 5, 6};
  std::vector<double> sq_errors;
  for (const Shape& shape :
       {moved(box(1000, Sampling::Random, 1), randomPose(1)), moved(prism(5, 1000, Sampling::Random, 2), randomPose(2)),
        moved(asymmetricBlob(1000, 3), randomPose(3)), moved(cylinder(1000, 4), randomPose(4))}) {
    const GaussianEdt edt = edtOf(shape.cloud());
    const AxisGrid grid(4, 8, 8, edt.center(), edt.radius());
    const AxisMap map = axialTransform(edt, grid, options);
    RandomStream random(5);
    for (int i = 0; i < 12;) {
      const std::size_t bin = random.below(grid.size());
      if (map.greatest[bin] == 0.0f) continue;  // beyond the ball
      const std::size_t fold = i++ % options.folds.size();
      const double exact = fullSum(edt, grid.axis(grid.bin(bin)), options.folds[fold], edt);
      // The length of the invariant part of f, as PRST for planes: sqrt((1 + (n - 1) D) / n), sqrt(D) for any angle.
      const auto length = [&](double d) {
        const int n = options.folds[fold];
        return n == 0 ? std::sqrt(std::max(0.0, d)) : std::sqrt(std::max(0.0, (1.0 + (n - 1) * d) / n));
      };
      sq_errors.push_back(std::pow(length(map.values[fold][bin]) - length(exact), 2));
    }
  }
  EXPECT_LE(std::sqrt(meanOf(sq_errors)), 0.01);
}

TEST(AxialTransform, FindsTheOrderOfTurns) {
  // A flat prism with n sides, a cylinder: the axis along z has that order. (Of five:
  // test_axial_symmetry_transform.cpp.)
  const auto foldAlongZ = [](const Shape& shape) {
    AxialTransformOptions options;
    options.folds = {0, 2, 3, 5, 6};
    options.num_samples = 64;
    const GaussianEdt edt = edtOf(shape.cloud());
    const AxisMap map = axialTransform(edt, AxisGrid(8, 24, 12, edt.center(), edt.radius()), options);
    for (const AxisMaximum& maximum : axisMaxima(map, edt, 12, 0.8, options))
      if (std::abs(maximum.axis.direction().z()) > std::cos(5.0 * kDegree)) return maximum.fold;
    return -1;
  };
  for (const int n : {3, 6}) EXPECT_EQ(foldAlongZ(prism(n, 4000, Sampling::Random, n)), n);
  EXPECT_EQ(foldAlongZ(cylinder(4000, 1)), 0);
}

TEST(AxialTransform, BestFoldIsTheGreatestOfEqualOnes) {
  EXPECT_EQ(bestFold({0, 2, 3, 6}, {0.5, 1.0, 0.998, 0.997}), 6);
  EXPECT_EQ(bestFold({0, 2, 3, 6}, {0.997, 1.0, 0.99, 0.99}), 0);
  EXPECT_EQ(bestFold({2, 4, 0}, {1.0, 0.6, 0.4}), 2);
}

TEST(AxialTransform, DoesNotDependOnThreads) {
  const GaussianEdt edt = edtOf(asymmetricBlob(1000, 3).cloud());
  const AxisGrid grid(4, 8, 20, edt.center(), edt.radius());
  compareThreads([&](int num_threads) {
    AxialTransformOptions options;
    options.num_threads = num_threads;
    return std::pair(axialTransform(edt, grid, options).values, centralTransform(edt, 12, options).values);
  });
}

TEST(AxialTransform, RefusesBadOptions) {
  AxialTransformOptions options;
  const auto message = [&] { return complaintOf<std::invalid_argument>([&] { options.validate(); }); };
  options.folds = {2, 1};
  EXPECT_EQ(message(), "fold = 1, must be 0 or in [2, 60]");
  options.folds = {2, 2};
  EXPECT_EQ(message(), "fold = 2, must be named once");
  options.folds = {};
  EXPECT_EQ(message(), "number of folds = 0, must be >= 1");
}

TEST(AxialTransform, PointsOnTheAxisHaveItsValue) {
  const GaussianEdt edt = edtOf(prism(3, 3000, Sampling::Random, 3).cloud());
  AxialTransformOptions options;
  options.folds = {3};
  const AxisMap map = axialTransform(edt, AxisGrid(12, 48, 16, edt.center(), edt.radius()), options);
  Points points(3, 3);
  points << 0.0f, 0.0f, 0.6f, 0.0f, 0.0f, 0.0f, 0.0f, 0.4f, 0.3f;
  const std::vector<float> values = axialPointSymmetry(map, points, 1);
  const float most = map.greatest[map.strongest()];
  EXPECT_NEAR(values[0], most, 0.1);
  EXPECT_NEAR(values[1], most, 0.1);
  EXPECT_LT(values[2], 0.9f * values[1]);
  EXPECT_EQ(axialPointSymmetry(AxisMap(), points, 1), std::vector<float>(3, 0.0f));
  points.col(0) << 90.0f, 0.0f, 0.0f;
  EXPECT_LE(axialPointSymmetry(map, points, 2)[0], most);
}

TEST(CentralTransform, IsWithinOnePerCentOfTheFullSum) {
  std::vector<double> sq_errors;
  for (const Shape& shape : {moved(box(1000, Sampling::Random, 1), randomPose(1)),
                             moved(asymmetricBlob(1000, 3), randomPose(3)), moved(cylinder(1000, 4), randomPose(4))}) {
    const GaussianEdt edt = edtOf(shape.cloud());
    const CenterMap map = centralTransform(edt, 16);
    RandomStream random(5);
    for (int i = 0; i < 40; ++i) {
      const std::size_t at = random.below(map.values.size());
      const Eigen::Vector3d center = map.center(at);
      const double exact = correlation(edt, [&](const Eigen::Vector3d& x) { return edt(2.0 * center - x); });
      const auto length = [](double d) { return std::sqrt(std::max(0.0, 0.5 * (1.0 + d))); };
      sq_errors.push_back(std::pow(length(map.values[at]) - length(exact), 2));
      EXPECT_NEAR(map(center), map.values[at], 1e-5);
    }
  }
  EXPECT_LE(std::sqrt(meanOf(sq_errors)), 0.01);
}

TEST(CentralTransform, FindsTheCenterOfABoxAndNoneOfATetrahedron) {
  const Shape shape = moved(box(3000, Sampling::Random, 4), randomPose(4));
  const GaussianEdt edt = edtOf(shape.cloud(), 64);
  const CenterMap map = centralTransform(edt);
  const Eigen::Vector3d center = randomPose(4) * Eigen::Vector3d::Zero();
  EXPECT_LT((map.center(map.strongest()) - center).norm(), 1.5 * map.step);
  EXPECT_GT(map.values[map.strongest()], 0.8f);
  const GaussianEdt other = edtOf(scaleneTetrahedron(3000, 5).cloud(), 64);
  const CenterMap none = centralTransform(other);
  EXPECT_LT(none.values[none.strongest()], 0.6f);
}

TEST(AxialTransform, FreeSpaceCountsAgainstAxes) {
  // A half cylinder seen from outside. F counts both ways of turning: one may lead behind the surface, one before it.
  Points points(3, 4000);
  for (int i = 0; i < 4000; ++i) {
    const double angle = kPi * (i % 50 + 0.5) / 50.0, z = 2.0 * (i / 50) / 80.0 - 1.0;
    points.col(i) << static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), static_cast<float>(z);
  }
  const GaussianEdt edt = edtOf(points);
  const std::optional<Visibility> seen = Visibility::fromPoints(points, Eigen::Vector3d(0.0, 6.0, 0.0));
  ASSERT_TRUE(seen.has_value());
  AxialTransformOptions options;
  options.folds = {3};
  const AxisGrid grid(4, 8, 8, edt.center(), edt.radius());
  const AxisMap map = axialTransform(edt, grid, options, &*seen);
  const std::vector<float> free = freeSpace(edt, &*seen);
  RandomStream random(3);
  double greatest_f = 0.0;
  const double middle = 0.5 * (edt.numCells() - 1);
  for (int i = 0; i < 20; ++i) {
    const std::size_t bin = random.below(grid.size());
    if (map.greatest[bin] == 0.0f) continue;
    const Line3d axis = grid.axis(grid.bin(bin));
    const double f = fullSum(edt, axis, 3, [&](const Eigen::Vector3d& x) {
      const Eigen::Array3d at = ((x - edt.origin()) / edt.cellSize()).array();
      // What lies beyond the ball in the cube of cells counts neither as surface nor as free.
      if ((at - middle).matrix().norm() > middle - 0.5) return 0.0f;
      const Eigen::Array3i c = at.round().cast<int>();
      return free[static_cast<std::size_t>((c.z() * edt.numCells() + c.y()) * edt.numCells() + c.x())];
    });
    greatest_f = std::max(greatest_f, f);
    EXPECT_NEAR(map.greatest[bin], seenSymmetry(fullSum(edt, axis, 3, edt), f), 0.06) << "F = " << f;
  }
  EXPECT_GT(greatest_f, 0.3);
}

}  // namespace
