/// Stray points: found wherever they lie, and never a part of a shape.
#include "core/geometry/point_samples.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/random.h"
#include "core/geometry/cloud_extent.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// Points at 2 to 20 sizes from the middle of a cloud, in random directions.
Points aboutCloud(const Points& cloud, int count, std::uint64_t seed) {
  RandomStream random(seed);
  const double size = farthestPair(cloud);
  Points stray(3, count);
  for (int k = 0; k < count; ++k)
    stray.col(k) =
        (centerOfMass(cloud) + size * (2.0 + 18.0 * random.uniform()) * randomDirection(random)).cast<float>();
  return stray;
}

/// A straight row of points of length 1 from a point away from the origin.
Points rod(const Eigen::Vector3f& from, float length, int count, int thick = 1) {
  Points points(3, count * thick);
  for (int k = 0; k < count * thick; ++k)
    points.col(k) = from * (1.0f + length * static_cast<float>(k / thick + 1) / static_cast<float>(count)) +
                    0.005f * static_cast<float>(k % thick) * Eigen::Vector3f::UnitY();
  return points;
}

TEST(StrayPoints, AreFoundWhereverTheyLie) {
  for (const int size : {200, 1000, 5000, 30'000})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const Points cloud =
          moved(seed % 2 ? box(size, Sampling::Random, seed) : asymmetricBlob(size, seed), randomPose(seed)).cloud();
      const int count = static_cast<int>(seed);
      const Points all = joined(aboutCloud(cloud, count, seed), cloud);
      std::vector<int> expected;
      for (int k = 0; k < count; ++k) expected.push_back(k);
      EXPECT_EQ(strayPoints(all), expected) << size << " points, seed " << seed;
      EXPECT_EQ(withoutStrayPoints(all), cloud);
    }
}

TEST(StrayPoints, MakeNoLineOfTheOthersHoweverFarTheyAre) {
  const Points cloud = box(2000, Sampling::Random, 3).cloud();
  for (const float far : {1e3f, 1e7f, 1e12f, 1e18f})
    EXPECT_EQ(whyUnanswerable(joined(cloud, Eigen::Vector3f(far, 0.0f, 0.0f))), "") << far;
}

TEST(StrayPoints, OfOnePositionAreOne) {
  const Points cloud = box(2000, Sampling::Random, 3).cloud();
  const Points far = cloud.colwise() + Eigen::Vector3f(50.0f, 0.0f, 0.0f);
  EXPECT_EQ(strayPoints(joined(far, Points::Zero(3, 90))).size(), 90u) << "what a driver set to zero";
  EXPECT_TRUE(strayPoints(joined(far, Points::Zero(3, 300))).empty()) << "too many";
}

TEST(StrayPoints, AreNoPartsOfShapes) {
  for (const int size : {30, 60, 200, 1000, 5000}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      EXPECT_TRUE(strayPoints(box(size, Sampling::Random, seed).cloud()).empty());
      EXPECT_TRUE(strayPoints(box({10.0, 0.2, 0.1}, size, Sampling::Random, seed).cloud()).empty());
      EXPECT_TRUE(strayPoints(asymmetricBlob(size, seed).cloud()).empty());
    }
  }
  const Points ball = sphere(5000, 1).cloud();
  const Eigen::Vector3f top = Eigen::Vector3f::UnitZ();
  EXPECT_TRUE(strayPoints(joined(ball, rod(top, 4.0f, 10))).empty()) << "an antenna of few points";
  EXPECT_TRUE(strayPoints(joined(ball, rod(top, 4.0f, 20, 10))).empty()) << "a tail";
  const Points part = (0.1f * ball.leftCols(60)).colwise() + 3.0f * top;
  EXPECT_TRUE(strayPoints(joined(ball, part)).empty());
  const Points antenna = joined(ball, rod(top, 4.0f, 10));
  EXPECT_EQ(strayPoints(joined(antenna, aboutCloud(antenna, 3, 5))).size(), 3u) << "beyond an antenna";
}

}  // namespace
