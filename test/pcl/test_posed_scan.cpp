#include "recognition/posed_scan.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/base/constants.h"

namespace pcl_symmetry {

namespace {

/// The side of a cylinder, and at one side of it a box as a handle, which a sixth of the points show.
Points mug() {
  constexpr int kNumPoints = 6000;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  Points points(3, kNumPoints);
  for (int i = 0; i < kNumPoints; ++i) {
    const double angle = kPi * uniform(random);
    points.col(i) << static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), uniform(random);
    if (i % 6 == 0)
      points.col(i) << 1.3f + 0.3f * uniform(random), uniform(random) < 0 ? -0.1f : 0.1f, 0.6f * points(2, i);
  }
  return points;
}

double angleOf(const detail::PosedModel& posed) {
  return Eigen::AngleAxisd(posed.model.T_model_scan.linear()).angle();
}

}  // namespace

/// From a pose with the handle elsewhere no step leads to the true one, as the cylinder fits in both.
TEST(PosedScan, TriesRotationsAboutTheAxesOfAModel) {
  const Points points = mug();
  for (const double degrees : {50.0, 120.0, 180.0}) {
    detail::PosedScan scan(points, std::nullopt, RecognitionOptions::quickRegistration());
    scan.bringTo("mug", points, {Eigen::Isometry3d(Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitZ()))},
                 [&] { return points; });
    const std::vector<detail::PosedModel> found = scan.refined(1);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_GT(angleOf(found.front()), 45.0 * kDegree) << degrees;
    const detail::PosedModel rotated = scan.rotated(found.front());
    EXPECT_LT(angleOf(rotated), 2.0 * kDegree) << degrees;
    EXPECT_GT(rotated.model.score.support, 0.95) << degrees;
  }
}

/// All but the best two: the confidence needs a second one.
TEST(PosedScan, RefinesNoModelsFarBehindTheBest) {
  const Points points = mug();
  Points flat = points;
  flat.row(0) *= 0.2f;
  detail::PosedScan scan(points, std::nullopt, RecognitionOptions::quickRegistration());
  for (const char* name : {"flat 1", "flat 2", "flat 3"})
    scan.bringTo(name, flat, {Eigen::Isometry3d::Identity()}, [&] { return flat; });
  scan.bringTo("mug", points, {Eigen::Isometry3d::Identity()}, [&] { return points; });
  const std::vector<detail::PosedModel> found = scan.refined(4);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].model.name, "mug");
}

}  // namespace pcl_symmetry
