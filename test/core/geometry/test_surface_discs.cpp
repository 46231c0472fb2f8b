/// Distances from discs agree with a search over all of them.
#include "core/geometry/surface_discs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pcl_symmetry/core/closest_point_search.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

constexpr float kRadius = 1.25f, kReach = 0.1f;

/// Distance of a point from the nearest disc but that of \p self.
float byHand(const Points& samples, const LocalGeometry& geometry, const Eigen::Vector3f& x, int self = -1) {
  float least = std::numeric_limits<float>::infinity();
  for (int i = 0; i < samples.cols(); ++i) {
    if (i == self) continue;
    const Eigen::Vector3f difference = x - samples.col(i);
    const float across = geometry.normals.col(i).dot(difference);
    const float along = std::sqrt(std::max(0.0f, difference.squaredNorm() - across * across));
    least = std::min(least, std::hypot(across, std::max(0.0f, along - kRadius * geometry.spacing[i])));
  }
  return least;
}

TEST(SurfaceDiscs, AgreeWithASearchOverAll) {
  RandomStream random(3);
  Points samples(3, 400);
  for (Eigen::Index i = 0; i < samples.cols(); ++i)
    samples.col(i) =
        Eigen::Vector3d(gaussian(random), gaussian(random), 0.6 * gaussian(random)).normalized().cast<float>();
  const LocalGeometry geometry = localGeometry(samples, *makeFlannSearch(samples), kNumSupportNeighbours, 1);
  const SurfaceDiscs discs(samples, geometry, kRadius, kReach);
  int num_near = 0;
  for (int k = 0; k < 500; ++k) {
    const Eigen::Vector3f x = 1.3f * Eigen::Vector3f::Random();
    const float expected = byHand(samples, geometry, x);
    const SurfaceDiscs::Nearest nearest = discs.nearest(x);
    EXPECT_EQ(nearest.disc >= 0, expected <= kReach);
    if (nearest.disc >= 0) {
      EXPECT_NEAR(nearest.distance, expected, 1e-5f);
      ++num_near;
    }
    for (const float distance : {0.01f, 0.05f, kReach})
      if (std::abs(expected - distance) > 1e-5f) {
        EXPECT_EQ(discs.isWithin(x, distance), expected <= distance);
      }
  }
  EXPECT_GT(num_near, 20);
  for (int i = 0; i < 50; ++i) {
    const float expected = byHand(samples, geometry, samples.col(i), i);
    if (expected <= kReach) {
      EXPECT_NEAR(discs.ownDistance(i, 1.0f), expected, 1e-5f);
    }
  }
}

}  // namespace
