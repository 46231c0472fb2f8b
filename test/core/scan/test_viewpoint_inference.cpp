/// Single views are told from everything else by the points alone.
#include "core/scan/viewpoint_inference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shapes/scans.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

const Eigen::Vector3d kElsewhere(0.1, 0.2, 0.3);  // among the points: explains none of the clouds

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.normalized().dot(b.normalized()))) / kDegree;
}

TEST(InferView, FindsTheViewpointOfAScanInAnyPose) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    RandomStream random(seed);
    const Eigen::Vector3d viewpoint = 4.0 * randomDirection(random);
    for (const BlockObject& object : {blockL(), blockChair()}) {
      const Eigen::Isometry3d pose = randomPose(seed, 3.0);
      const Points points = (pose * scan(object, viewpoint).cloud().cast<double>()).cast<float>();
      const auto view = inferView(points, kElsewhere);
      ASSERT_TRUE(view) << seed;
      EXPECT_FALSE(view->as_stored);
      const Eigen::Vector3d center = boundingBall(points).center;
      // Measured: at most 11 degrees with three directions of the surface, 1 in the middle for curved objects.
      EXPECT_LT(angleBetween(view->position - center, pose * viewpoint - center), 15.0) << seed;
      EXPECT_LT((view->seen.viewpoint() - view->position).norm(), 1e-9) << seed;
    }
  }
}

TEST(InferView, PrefersTheStoredViewpointWhereItIsTrue) {
  const Eigen::Vector3d viewpoint(2.5, -3.0, 2.0);
  const auto view = inferView(scan(blockL(), viewpoint).cloud(), viewpoint);
  ASSERT_TRUE(view);
  EXPECT_TRUE(view->as_stored);
  EXPECT_EQ(view->position, viewpoint);
}

TEST(InferView, FindsNoneForWires) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RandomStream random(seed);
    Points wire(3, 40 + 40 * static_cast<int>(seed));
    for (Eigen::Index i = 0; i < wire.cols(); ++i) {
      const double t = random.uniform(), angle = 5.0 * t;
      wire.col(i) =
          Eigen::Vector3d((0.3 + t) * std::cos(angle), (0.3 + t) * std::sin(angle), t + 0.003 * gaussian(random))
              .cast<float>();
    }
    EXPECT_FALSE(inferView(wire, kElsewhere)) << seed;
  }
}

TEST(InferView, FindsNoneForWholeObjects) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const int count : {1000, 10'000})
      for (const Shape& shape : {box(count, Sampling::Random, seed), sphere(count, seed), cylinder(count, seed),
                                 scaleneTetrahedron(count, seed)}) {
        const Points cloud = shape.cloud();
        EXPECT_FALSE(inferView(cloud, Eigen::Vector3d::Zero())) << seed << ", " << count;
        EXPECT_FALSE(inferView(cloud, {3.0, 1.0, 2.0})) << seed << ", " << count;
      }
}

TEST(InferView, FindsNoneForOpenShellsAndSheets) {
  // Half a sphere and a sheet are seen once from many positions. Their even density is not that of a scan.
  const Points whole = sphere(20'000, 1).cloud();
  EXPECT_FALSE(inferView(facing(whole, whole, {0.0, 0.0, 100.0}), {0.0, 0.0, 4.0}));
  RandomStream random(6);
  Points sheet(3, 4000);
  for (Eigen::Index i = 0; i < sheet.cols(); ++i)
    sheet.col(i) = Eigen::Vector3d(symmetric(random), symmetric(random), 0.0).cast<float>();
  EXPECT_FALSE(inferView(sheet, {0.0, 0.0, 4.0}));
}

TEST(InferView, FindsNoneForTwoViewsPutTogether) {
  for (const Eigen::Vector3d& second : {Eigen::Vector3d(-2.5, -3.0, 2.0), Eigen::Vector3d(-2.5, 3.0, -2.0)}) {
    for (const BlockObject& object : {blockBox(), blockL(), blockChair()}) {
      const Points a = scan(object, {2.5, -3.0, 2.0}).cloud(), b = scan(object, second).cloud();
      Points both(3, a.cols() + b.cols());
      both << a, b;
      EXPECT_FALSE(inferView(both, kElsewhere)) << second.transpose();
    }
  }
}

TEST(InferView, FewOrDegeneratePointsHaveNone) {
  EXPECT_FALSE(inferView(Points(3, 0), kElsewhere));
  EXPECT_FALSE(inferView(Points::Ones(3, 100), kElsewhere));
  EXPECT_FALSE(inferView(Points::Random(3, 19), kElsewhere));
}

}  // namespace
