/// The motion that pairs of points, and of points and planes, ask for.
#include "core/registration/pose_covariance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

enum class Pairs { Points, Planes, Both };

/// \return the motion that brings \p num_pairs random points to where \p true_motion has them, lengths times \p scale.
Eigen::Isometry3d solved(const Eigen::Isometry3d& true_motion, int num_pairs, Pairs pairs, double scale = 1.0) {
  MotionEquations equations(scale);
  for (int i = 0; i < num_pairs; ++i) {
    const Eigen::Isometry3d random = randomPose(static_cast<std::uint64_t>(i) + 1, 1.0);
    const Eigen::Vector3d x = random.translation(), y = true_motion * x;
    const double weight = 0.5 + 0.5 * std::abs(random.linear()(0, 0));
    if (pairs != Pairs::Planes) equations.addPoint(scale * x, scale * y, weight);
    if (pairs != Pairs::Points) equations.addPlane(scale * x, scale * y, random.linear().col(1), weight);
  }
  Eigen::Isometry3d motion = equations.motion();
  motion.translation() /= scale;
  return motion;
}

Eigen::Isometry3d smallMotion() {
  return Eigen::Translation3d(2e-4, -5e-4, 3e-4) *
         Eigen::AngleAxisd(1e-3, Eigen::Vector3d(1.0, -2.0, 0.5).normalized());
}

TEST(MotionEquations, FindTheMotionOfAnyNumberOfPairs) {
  const Eigen::Isometry3d motion = smallMotion();
  for (const Pairs pairs : {Pairs::Points, Pairs::Planes, Pairs::Both})
    for (const int num_pairs : {9, 127, 128, 129, 1000})
      EXPECT_LT((solved(motion, num_pairs, pairs).matrix() - motion.matrix()).norm(), 1e-5)
          << num_pairs << " pairs of kind " << static_cast<int>(pairs);
}

TEST(MotionEquations, DoNotDependOnTheUnitOfLength) {
  const Eigen::Isometry3d motion = smallMotion();
  for (const double scale : {1e-4, 1e4})
    EXPECT_LT((solved(motion, 50, Pairs::Both, scale).matrix() - solved(motion, 50, Pairs::Both).matrix()).norm(), 1e-9)
        << scale;
}

TEST(MotionEquations, WithoutPairsNothingMoves) {
  EXPECT_TRUE(MotionEquations(1.0).motion().matrix().isIdentity());
}

}  // namespace
