#include "core/evidence/split_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/evidence/surface_samples.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
