/// What the density of points says about where they were measured from.
#include "core/scan/scan_density.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shapes/scans.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(ScanDensity, FallsWithSlantAndDistance) {
  const Eigen::Vector3d viewpoint(2.5, -3.0, 2.0);
  const ScanDensity density(scan(blockBox(), viewpoint).cloud());
  // The three faces slant by 50 degrees on average and differ by a factor of 1.5 in cos a / d^2.
  EXPECT_GT(density.variance(), 0.01);
  EXPECT_LT(density.unexplained(viewpoint), 0.1 * density.variance());
  EXPECT_LT(density.unexplainedByPatches(viewpoint), 0.005);
  EXPECT_GT(density.unexplained(-viewpoint), 10.0 * density.unexplained(viewpoint)) << "from behind";
  EXPECT_GT(density.unexplained(0.6 * viewpoint), 2.0 * density.unexplained(viewpoint)) << "from too near";
}

TEST(ScanDensity, TwoFlatFacesAreAsDenseFromSeveralPlaces) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    RandomStream random(seed);
    Eigen::Vector3d along = randomDirection(random);
    along.z() = 0.0;  // level with the box: it shows two faces
    const Eigen::Vector3d viewpoint = 4.0 * along.normalized();
    const ScanDensity density(scan(blockBox(), viewpoint).cloud());
    const std::vector<Eigen::Vector3d> found = density.viewpoints(density.unexplained(viewpoint) + 2e-3);
    double nearest = -1.0;
    for (const Eigen::Vector3d& position : found)
      nearest = std::max(
          nearest,
          (position - density.ball().center).normalized().dot((viewpoint - density.ball().center).normalized()));
    // Measured: at most 9 degrees.
    EXPECT_GT(nearest, std::cos(15.0 * kDegree)) << seed << ": " << found.size();
  }
  EXPECT_TRUE(ScanDensity(Points::Ones(3, 5)).viewpoints(1.0).empty());
}

TEST(ScanDensity, EvenPointsHaveNothingToExplain) {
  // The density of 16 neighbors of random points has a variance of 1 / 16, less without its tails.
  const ScanDensity density(box(10'000, Sampling::Random, 1).cloud());
  EXPECT_LT(density.variance(), 1.0 / 16.0);
  RandomStream random(4);
  for (int i = 0; i < 20; ++i)
    EXPECT_GT(density.unexplained(4.0 * randomDirection(random)), 0.9 * density.variance()) << i;
}

TEST(ScanDensity, TooFewPointsAndPointsWithoutExtentHaveNoViewpoint) {
  EXPECT_FALSE(ScanDensity(Points(3, 0)).bestViewpoint());
  EXPECT_FALSE(ScanDensity(Points::Random(3, 10)).bestViewpoint());
  EXPECT_FALSE(ScanDensity(Points::Ones(3, 500)).bestViewpoint());
  Points line = Points::Zero(3, 500);
  line.row(0).setLinSpaced(0.0f, 1.0f);
  EXPECT_FALSE(ScanDensity(line).bestViewpoint()) << "no surface";
  EXPECT_TRUE(std::isinf(ScanDensity(line).unexplained({5.0, 0.0, 0.0})));
}

}  // namespace
