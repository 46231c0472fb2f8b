/// Sides of a picture that cut the object.
#include "core/scan/picture_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pcl_symmetry/core/visibility.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

constexpr double kPixel = 0.01, kRoll = 0.3;

Eigen::Array2d turned(double x, double y, double roll = kRoll) {
  return {std::cos(roll) * x - std::sin(roll) * y, std::sin(roll) * x + std::cos(roll) * y};
}

/// Pixels of a disc of 40 pixels, at most \p right columns to the right of its middle and \p up rows above it.
std::vector<Eigen::Array2d> disc(int right, int up) {
  std::vector<Eigen::Array2d> positions;
  for (int v = -40; v <= up; ++v)
    for (int u = -40; u <= right; ++u)
      if (std::hypot(u, v) <= 40.3) positions.push_back(turned(kPixel * u, kPixel * v));
  return positions;
}

TEST(FrameSides, ARoundObjectThatIsSeenAsAWholeHasNone) {
  EXPECT_TRUE(frameSides(disc(40, 40)).empty());
}

TEST(FrameSides, AreWhereTheLastRowIsAsLongAsTheOnesBefore) {
  const std::vector<FrameSide> one = frameSides(disc(25, 40));
  ASSERT_EQ(one.size(), 1u);
  // The search turns a side by a quarter of a degree at a time, and a row of 60 pixels by that is a quarter of a pixel.
  EXPECT_NEAR(one[0].offset, 25.5 * kPixel, 0.5 * kPixel);
  EXPECT_NEAR(one[0].normal.dot(turned(1.0, 0.0).matrix()), 1.0, 1e-3);
  EXPECT_EQ(frameSides(disc(25, 30)).size(), 2u);
}

TEST(FrameSides, CutLegsAreEnough) {
  // Four bars of twelve pixels that leave the picture, below a disc.
  std::vector<Eigen::Array2d> positions = disc(40, 40);
  for (int bar = 0; bar < 4; ++bar)
    for (int v = -70; v < -20; ++v)
      for (int u = 0; u < 12; ++u) positions.push_back(turned(kPixel * (-33 + 18 * bar + u), kPixel * v));
  const std::vector<FrameSide> sides = frameSides(positions);
  ASSERT_EQ(sides.size(), 1u);
  EXPECT_NEAR(sides[0].normal.dot(turned(0.0, -1.0).matrix()), 1.0, 1e-3);
}

TEST(FrameSides, PlacesWithoutRowsHaveNone) {
  std::vector<Eigen::Array2d> positions;
  RandomStream random(1);
  for (int i = 0; i < 5000; ++i)
    if (const Eigen::Array2d p(symmetric(random), symmetric(random)); p.matrix().norm() < 1.0 && p.x() < 0.6)
      positions.push_back(p);
  EXPECT_TRUE(frameSides(positions).empty());
  EXPECT_TRUE(frameSides({}).empty());
  EXPECT_TRUE(frameSides({{0.0, 0.0}}).empty());
  EXPECT_TRUE(frameSides(std::vector<Eigen::Array2d>(100, {1.0, 2.0})).empty());
}

TEST(FrameSides, BeyondThemNothingIsKnown) {
  // A unit sphere seen from a distance of 4, its picture cut off on the right.
  const double focal = 200.0;
  Points points(3, 0);
  std::vector<Eigen::Vector3f> hits;
  for (int v = -60; v <= 60; ++v)
    for (int u = -60; u <= 20; ++u) {
      const Eigen::Vector3d ray = Eigen::Vector3d(u / focal, v / focal, 1.0).normalized();
      const double along = 4.0 * ray.z(), sq_half = 1.0 - 16.0 + along * along;
      if (sq_half > 0.0) hits.push_back(((along - std::sqrt(sq_half)) * ray).cast<float>());
    }
  points.resize(3, static_cast<Eigen::Index>(hits.size()));
  for (std::size_t i = 0; i < hits.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = hits[i];
  const auto seen = Visibility::fromPoints(points, Eigen::Vector3d::Zero());
  ASSERT_TRUE(seen);
  constexpr double kFree = -std::numeric_limits<double>::infinity(), kUnknown = -kFree;
  for (const double depth : {3.0, 4.0, 9.0}) {
    const auto at = [&](double u, double v) {
      return seen->depthBehind(depth * Eigen::Vector3d(u / focal, v / focal, 1.0));
    };
    EXPECT_EQ(at(22.0, 0.0), kUnknown) << "right of the cut";
    EXPECT_EQ(at(80.0, 30.0), kUnknown);
    EXPECT_EQ(at(-60.0, 0.0), kFree) << "left of the sphere";
    EXPECT_EQ(at(0.0, 60.0), kFree);
    EXPECT_EQ(at(0.0, -60.0), kFree);
    // The same in other units and from another origin.
    const Visibility other = seen->normalized({1.0, -2.0, 3.0}, 2.5);
    const Eigen::Vector3d beyond = depth * Eigen::Vector3d(22.0 / focal, 0.0, 1.0);
    EXPECT_EQ(other.depthBehind((beyond - Eigen::Vector3d(1.0, -2.0, 3.0)) / 2.5), kUnknown);
  }
}

}  // namespace
