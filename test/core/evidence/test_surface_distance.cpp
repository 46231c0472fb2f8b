#include "core/evidence/surface_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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

}  // namespace
