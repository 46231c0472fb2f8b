#include "core/matching/turnable_prst.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "core/base/random.h"
#include "core/geometry/axis_rotations.h"

namespace pcl_symmetry {

namespace {

/// A slab with a block upon one corner: no two of its sides are alike.
Points corner() {
  Points points(3, 6000);
  RandomStream random(5);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Eigen::Vector3d x = Eigen::Vector3d::NullaryExpr([&](Eigen::Index) { return 2.0 * random.uniform() - 1.0; });
    x[i % 3] = x[i % 3] < 0.0 ? -1.0 : 1.0;
    x = i % 3 == 0 ? Eigen::Vector3d(0.4 * x.x() + 0.5, 0.2 * x.y() + 0.3, 0.5 * x.z() + 0.8)
                   : Eigen::Vector3d(x.x(), 0.6 * x.y(), 0.3 * x.z());
    points.col(i) = x.cast<float>();
  }
  return points;
}

Eigen::Map<const Eigen::VectorXf> asVector(const std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

TEST(TurnablePRST, HasUnitNorm) {
  const std::vector<float> prst = turnablePRST(corner(), Eigen::Matrix3d::Identity());
  ASSERT_EQ(prst.size(), static_cast<std::size_t>(kTurnablePRSTSize));
  EXPECT_NEAR(asVector(prst).norm(), 1.0, 1e-5);
}

TEST(TurnablePRST, QuarterTurnsAreWhatTurnedAxesGive) {
  const Points points = corner();
  const std::vector<float> prst = turnablePRST(points, Eigen::Matrix3d::Identity());
  std::vector<float> rotated(prst.size());
  for (int r = 0; r < kNumAxisRotations; ++r) {
    const Eigen::Matrix3i& rotation = axisRotations()[static_cast<std::size_t>(r)];
    if (rotation.trace() != 1) continue;  // 1 + 2 cos(90 degrees)
    const std::vector<float> expected = turnablePRST(points, rotation.transpose().cast<double>());
    rotateTurnablePRST(prst.data(), r, rotated.data());
    // Samples of the transform are drawn anew: the error of PRST is 1 to 2 %.
    EXPECT_LT((asVector(rotated) - asVector(expected)).norm(), 0.06) << r;
    EXPECT_GT((asVector(rotated) - asVector(prst)).norm(), 0.12) << r;
  }
}

/// Quarter turns generate all rotations: with the test above, all of them are right.
TEST(TurnablePRST, RotationsFollowEachOther) {
  std::vector<float> prst(kTurnablePRSTSize), once(prst.size()), twice(prst.size()), product(prst.size());
  std::iota(prst.begin(), prst.end(), 0.0f);
  const auto& rotations = axisRotations();
  for (int a = 0; a < kNumAxisRotations; ++a) {
    rotateTurnablePRST(prst.data(), a, once.data());
    EXPECT_TRUE(a == 0 || once != prst) << a;
    for (int b = 0; b < kNumAxisRotations; ++b) {
      rotateTurnablePRST(once.data(), b, twice.data());
      const Eigen::Matrix3i both = rotations[static_cast<std::size_t>(b)] * rotations[static_cast<std::size_t>(a)];
      const auto at = std::find(rotations.begin(), rotations.end(), both);
      rotateTurnablePRST(prst.data(), static_cast<int>(at - rotations.begin()), product.data());
      EXPECT_EQ(twice, product) << a << ' ' << b;
    }
  }
}

TEST(TurnablePRST, RefusesWhatHasNoExtent) {
  EXPECT_THROW(turnablePRST(Points(3, 0), Eigen::Matrix3d::Identity()), std::invalid_argument);
  EXPECT_THROW(turnablePRST(Points(Points::Ones(3, 5)), Eigen::Matrix3d::Identity()), std::invalid_argument);
  Points bad = corner();
  bad(0, 3) = std::numeric_limits<float>::infinity();
  EXPECT_THROW(turnablePRST(bad, Eigen::Matrix3d::Identity()), std::invalid_argument);
}

}  // namespace pcl_symmetry
