#include "core/matching/turnable_gedt.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/geometry/axis_rotations.h"

namespace pcl_symmetry {
namespace {

/// A box that is asymmetric by what lies on it.
Points uneven() {
  Points points(3, 4000);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const float u = static_cast<float>(i % 63) / 62.0f, v = static_cast<float>(i / 63) / 63.0f;
    points.col(i) = i % 3 == 0 ? Eigen::Vector3f(u, 0.6f * v, 0.0f)
                               : Eigen::Vector3f(0.3f * u, 0.2f * v, 0.1f + 0.3f * u * u + 0.1f * v);
  }
  return points;
}

Eigen::Map<const Eigen::VectorXf> gedtVector(const std::vector<float>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

TEST(TurnableGEDT, HasUnitNorm) {
  const std::vector<float> gedt = turnableGEDT(uneven(), Eigen::Matrix3d::Identity());
  ASSERT_EQ(gedt.size(), static_cast<std::size_t>(kTurnableGEDTSize));
  EXPECT_NEAR(gedtVector(gedt).norm(), 1.0, 1e-5);
}

TEST(TurnableGEDT, RotationsAreWhatTurnedAxesGive) {
  const Points points = uneven();
  const std::vector<float> gedt = turnableGEDT(points, Eigen::Matrix3d::Identity());
  std::vector<float> rotated(gedt.size());
  for (int r = 1; r < kNumAxisRotations; ++r) {
    const Eigen::Matrix3i& rotation = axisRotations()[static_cast<std::size_t>(r)];
    const std::vector<float> expected = turnableGEDT(points, rotation.transpose().cast<double>());
    rotateTurnableGEDT(gedt.data(), r, rotated.data());
    EXPECT_LT((gedtVector(rotated) - gedtVector(expected)).norm(), 1e-3) << r;
    EXPECT_GT((gedtVector(rotated) - gedtVector(gedt)).norm(), 0.1) << r;
  }
}

TEST(TurnableGEDT, RefusesPointsWithoutExtent) {
  EXPECT_THROW(turnableGEDT(Points::Ones(3, 5), Eigen::Matrix3d::Identity()), std::invalid_argument);
  Points points = uneven();
  points(0, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(turnableGEDT(points, Eigen::Matrix3d::Identity()), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
