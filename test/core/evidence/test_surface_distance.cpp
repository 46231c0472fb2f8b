/// Distances from a sampled surface, and those of one half of its samples from the other.
#include "core/evidence/surface_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/evidence/split_surface.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using namespace test;

/// A square lattice in z = 0, from -2 to 2, of spacing 0.1.
Points lattice() {
  Points points(3, 41 * 41);
  for (int i = 0; i < 41 * 41; ++i) points.col(i) << 0.1f * (i % 41 - 20), 0.1f * (i / 41 - 20), 0.0f;
  return points;
}

double distanceOf(const Eigen::Vector3f& x) {
  const Points surface = lattice(), point = x;
  const auto search = makeFlannSearch(surface);
  const LocalGeometry geometry = localGeometry(surface, *search, kNumSupportNeighbours, 1);
  std::vector<int> closest;
  std::vector<float> sq_distances;
  search->search(point, 1, closest, sq_distances);
  return surfaceDistances(point, closest, {surface, geometry})[0];
}

TEST(SurfaceDistance, IsThatOfDiscsAroundTheSamples) {
  EXPECT_NEAR(distanceOf({0.03f, 0.04f, 0.0f}), 0.0, 1e-5) << "between samples";
  EXPECT_NEAR(distanceOf({0.03f, 0.04f, 0.07f}), 0.07, 1e-5) << "above the surface";
  EXPECT_NEAR(distanceOf({0.03f, 0.04f, -0.07f}), 0.07, 1e-5) << "below it";
  // Beside the rim: the disc of a sample there is wider than elsewhere, because the neighbours lie to one side.
  const double beside = distanceOf({2.5f, 0.0f, 0.0f});
  EXPECT_LT(beside, 0.5 - 0.1);
  EXPECT_GT(beside, 0.5 - 0.35);
  EXPECT_NEAR(distanceOf({2.6f, 0.0f, 0.0f}) - beside, 0.1, 1e-5);
}

TEST(SurfaceDistance, IsInfiniteWhereNoSampleIsNear) {
  const Points surface = lattice(), point = Eigen::Vector3f::Zero();
  const LocalGeometry geometry = localGeometry(surface, *makeFlannSearch(surface), kNumSupportNeighbours, 1);
  EXPECT_TRUE(std::isinf(surfaceDistances(point, {-1}, {surface, geometry})[0]));
}

TEST(SurfaceDistance, OwnDistancesAreThoseOfASecondSampleOfANoisySurface) {
  // The share within a tolerance of one noise deviation: of the samples themselves, and of as many new points.
  const float noise = 0.05f;
  Points first = lattice(), second = lattice();
  RandomStream random(5);
  for (Eigen::Index i = 0; i < first.cols(); ++i) {
    first.col(i).z() = noise * static_cast<float>(gaussian(random));
    second.col(i) += Eigen::Vector3f(0.05f, 0.05f, noise * static_cast<float>(gaussian(random)));
  }
  const auto search = makeFlannSearch(first);
  const LocalGeometry geometry = localGeometry(first, *search, kNumSupportNeighbours, 1);
  std::vector<int> closest;
  std::vector<float> sq_distances;
  search->search(second, 1, closest, sq_distances);
  const double own = shareWithin(ownSurfaceDistances({first, geometry}), noise);
  const double other = shareWithin(surfaceDistances(second, closest, {first, geometry}), noise);
  // The standard error of either is 0.012. Without the factor for new points, own exceeds other by 0.1 and more.
  EXPECT_NEAR(own, other, 0.06);
}

TEST(SurfaceDistance, ShareCountsTheLimit) {
  EXPECT_EQ(shareWithin({0.0f, 0.5f, 1.0f, 2.0f}, 0.5), 0.5);
}

constexpr double kTolerance = 0.04;

/// A box with noise of more than its spacing (0.04), symmetric about x = 0.
Points noisyBox(double noise) {
  Points points(3, 6000);
  RandomStream random(3);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Eigen::Vector3d x(1 * (2.0 * random.uniform() - 1.0), 0.6 * (2.0 * random.uniform() - 1.0),
                      0.3 * (2.0 * random.uniform() - 1.0));
    const Eigen::Vector3d half(1.0, 0.6, 0.3);
    const int side = static_cast<int>(random.below(3));
    x[side] = random.below(2) == 0 ? half[side] : -half[side];
    for (int k = 0; k < 3; ++k) x[k] += noise * gaussian(random);
    points.col(i) = x.cast<float>();
  }
  return points;
}

TEST(SplitSurface, ATruePlaneReachesTheShareOfTheHalvesWhateverTheNoise) {
  for (const double noise : {0.0, 0.03, 0.08}) {
    SCOPED_TRACE(noise);
    const SplitSurface halves(noisyBox(noise), 1, 1);
    const double own = shareWithin(halves.ownDistances(), kTolerance);
    const double mapped = shareWithin(halves.reflectedDistances({Eigen::Vector3d::UnitX(), 0.0}), kTolerance);
    // derived: 3000 points each, four standard errors of a difference of shares.
    EXPECT_NEAR(mapped, own, 4.0 * std::sqrt(2.0 * own * (1.0 - own) / 3000.0) + 0.002);
    const double moved = shareWithin(halves.reflectedDistances({Eigen::Vector3d::UnitX(), 0.1}), kTolerance);
    EXPECT_LT(moved, 0.97 * own) << "a plane that maps one side 0.2 away";
  }
}

/// D of a true plane is what the halves and quarters of the cloud make expect.
TEST(SplitSurface, OwnScoreIsThatOfATruePlane) {
  for (const double noise : {0.04, 0.08}) {
    SCOPED_TRACE(noise);
    const Points points = noisyBox(noise);
    const BoundingBall ball{Eigen::Vector3d::Zero(), 1.5};
    const double own = SplitSurface(points, 1, 1).ownScore(64, 0.1, ball, 1);
    GaussianEdtOptions options;
    options.sigma = 0.1;
    options.radius = ball.radius;
    const auto scoreOf = [&](const ReflectionPlane& plane) {
      Points reflected = points;
      for (Eigen::Index i = 0; i < points.cols(); ++i)
        reflected.col(i) = plane.reflect(points.col(i).cast<double>()).cast<float>();
      const GaussianEdt a(points, options), b(reflected, options);
      return std::inner_product(a.values().begin(), a.values().end(), b.values().begin(), 0.0) /
             std::sqrt(a.sqNorm() * b.sqNorm());
    };
    // derived: three times the deviation of D of true planes (evidence/README.md).
    for (const int axis : {0, 1, 2}) EXPECT_NEAR(scoreOf({Eigen::Vector3d::Unit(axis), 0.0}), own, 0.006) << axis;
    EXPECT_LT(scoreOf({Eigen::Vector3d::UnitX(), 0.1}), own - 0.02) << "a plane that maps one side 0.2 away";
  }
}

}  // namespace
}  // namespace pcl_symmetry
