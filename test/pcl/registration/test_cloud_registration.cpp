#include "pcl_symmetry/registration/symmetry_registration.h"

#include <gtest/gtest.h>

#include "core/base/constants.h"
#include "core/base/random.h"

namespace pcl_symmetry {
namespace {

/// Points on the faces of a box of 4 x 3 x 2, and on a block on its top that leaves it no symmetry.
Points blockOnBox(std::uint64_t seed) {
  RandomStream random(seed);
  Points points(3, 3000);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const bool block = i % 4 == 0;
    const Eigen::Vector3d low = block ? Eigen::Vector3d(0.6, 0.3, 1.0) : Eigen::Vector3d(-2.0, -1.5, -1.0);
    const Eigen::Vector3d high = block ? Eigen::Vector3d(1.6, 1.2, 1.8) : Eigen::Vector3d(2.0, 1.5, 1.0);
    Eigen::Vector3d x;
    for (int k = 0; k < 3; ++k) x[k] = low[k] + random.uniform() * (high[k] - low[k]);
    const auto face = random.below(6);
    x[face / 2] = face % 2 ? high[face / 2] : low[face / 2];
    points.col(i) = x.cast<float>();
  }
  return points;
}

TEST(RegisterClouds, FindsALargeMotionBetweenTwoSamplings) {
  const Eigen::Isometry3d T_target_source =
      Eigen::Translation3d(5.0, -3.0, 8.0) * Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, 2.0, -0.5).normalized());
  const Points source = blockOnBox(1);
  const Points target = (T_target_source * blockOnBox(2).cast<double>()).cast<float>();
  const CloudRegistration found =
      registerClouds(source, std::nullopt, target, std::nullopt, Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d error = T_target_source.inverse() * found.T_target_source;
  // 3000 points on an area of 60 lie 0.14 apart: over a size of 5 that is 1.6 degrees for a single point.
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 1.0 * kDegree);
  EXPECT_LT(error.translation().norm(), 0.07);  // half a spacing
  EXPECT_GT(found.score.support, 0.5);
}

TEST(RegisterClouds, RefusesPointsWithoutExtentAndBadOptions) {
  const Points points = blockOnBox(1);
  const auto start = Eigen::Isometry3d::Identity();
  EXPECT_THROW(registerClouds(Points::Zero(3, 50), std::nullopt, points, std::nullopt, start), std::invalid_argument);
  EXPECT_THROW(registerClouds(points, std::nullopt, points.leftCols(1), std::nullopt, start), std::invalid_argument);
  CloudRegistrationOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(registerClouds(points, std::nullopt, points, std::nullopt, start, options), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
