#include "pcl_symmetry/core/viewpoint_score.h"

#include <gtest/gtest.h>

#include "core/geometry/directions.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using namespace test;

std::vector<ViewPlane> randomPlanes(int size, std::uint64_t seed) {
  RandomStream random(seed);
  std::vector<ViewPlane> planes;
  for (int i = 0; i < size; ++i) planes.push_back({randomDirection(random), random.uniform()});
  return planes;
}

TEST(ViewpointScore, IsTheWeightedSum) {
  const std::vector<ViewPlane> planes{{Eigen::Vector3d::UnitX(), 1.0}, {Eigen::Vector3d::UnitY(), 0.5}};
  EXPECT_DOUBLE_EQ(viewpointScore(planes, Eigen::Vector3d(-0.6, 0.0, 0.8)), 0.6);
  EXPECT_DOUBLE_EQ(viewpointScore(planes, Eigen::Vector3d(0.6, 0.8, 0.0)), 1.0);
}

TEST(BestViews, OfThreePlanesAcrossEachOtherAreTheirWeights) {
  // |a x| + |b y| + |c z| on the sphere is greatest at (+-a, +-b, +-c) / |(a, b, c)|, by Cauchy and Schwarz.
  const Eigen::Vector3d weights(0.9, 0.5, 0.3);
  const Eigen::Matrix3d axes = randomPose(8).linear();
  std::vector<ViewPlane> planes;
  for (int k = 0; k < 3; ++k) planes.push_back({axes.col(k), weights[k]});
  const std::vector<RankedView> views = bestViews(planes);
  ASSERT_EQ(views.size(), 8u);
  for (const RankedView& view : views) {
    EXPECT_NEAR(view.score, weights.norm(), 1e-12);
    EXPECT_LT(((axes.transpose() * view.direction).cwiseAbs() - weights.normalized()).norm(), 1e-12);
  }
}

TEST(BestViews, OfOnePlaneIsItsNormal) {
  const Eigen::Vector3d n = Eigen::Vector3d(1, 2, 3).normalized();
  const std::vector<RankedView> views = bestViews({{n, 0.7}});
  ASSERT_EQ(views.size(), 2u);
  EXPECT_NEAR(std::abs(views[0].direction.dot(n)), 1.0, 1e-12);
  EXPECT_TRUE(bestViews({}).empty());
  EXPECT_TRUE(bestViews({{n, 0.0}}).empty());
}

TEST(BestAndWorstViews, BoundEveryDirectionOfADenseSet) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const std::vector<ViewPlane> planes = randomPlanes(12, seed);
    const std::vector<RankedView> views = bestViews(planes);
    const RankedView worst = worstView(planes);
    ASSERT_FALSE(views.empty());
    for (const Eigen::Vector3d& v : evenDirections(20'000)) {
      EXPECT_LE(viewpointScore(planes, v), views[0].score);
      EXPECT_GE(viewpointScore(planes, v), worst.score);
    }
    for (const RankedView& view : views) EXPECT_NEAR(view.score, viewpointScore(planes, view.direction), 1e-12);
  }
}

TEST(WorstView, OfAPrismIsAlongItsAxis) {
  // n planes through z: none is seen across from there.
  std::vector<ViewPlane> planes;
  for (int k = 0; k < 5; ++k) planes.push_back({{-std::sin(kPi * k / 5), std::cos(kPi * k / 5), 0.0}, 1.0});
  const RankedView worst = worstView(planes);
  EXPECT_NEAR(std::abs(worst.direction.z()), 1.0, 1e-12);
  EXPECT_NEAR(worst.score, 0.0, 1e-12);
}

TEST(WorstView, OfOnePlaneLiesInItAndOfNoneIsRefused) {
  EXPECT_NEAR(worstView({{Eigen::Vector3d::UnitX(), 1.0}}).score, 0.0, 1e-12);
  EXPECT_THROW(worstView({}), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
