/// Which points hold an answer: their number, their extent, and whether they lie on a line.
#include "core/geometry/answerable_points.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// Points of a line segment of length 2 in a random pose.
Points line(int num_points, std::uint64_t seed, const Eigen::Vector3d& middle = Eigen::Vector3d::Zero()) {
  RandomStream random(seed);
  const Eigen::Vector3d direction = randomDirection(random);
  Points points(3, num_points);
  for (int i = 0; i < num_points; ++i) points.col(i) = (middle + symmetric(random) * direction).cast<float>();
  return points;
}

TEST(WhyUnanswerable, CountsDistinctPoints) {
  const Points twenty = box(20, Sampling::Random, 1).cloud();
  EXPECT_EQ(whyUnanswerable(twenty), "");
  EXPECT_EQ(whyUnanswerable(twenty.leftCols(19)), "19 distinct points, at least 20 are needed");
  EXPECT_EQ(whyUnanswerable(twenty.leftCols(12).replicate(1, 100)), "12 distinct points, at least 20 are needed");
  EXPECT_EQ(whyUnanswerable(Points::Constant(3, 1000, -1e9f)), "1 distinct point, at least 20 are needed");
  EXPECT_EQ(whyUnanswerable(Points(3, 0)), "0 distinct points, at least 20 are needed");
}

TEST(WhyUnanswerable, KnowsOnePlace) {
  // Coordinates of 1e9 are multiples of 64: these points differ by the last bit alone.
  Points points(3, 27);
  for (int i = 0; i < 27; ++i)
    points.col(i) = Eigen::Vector3f::Constant(1e9f) + 64.0f * Eigen::Vector3f(i % 3, i / 3 % 3, i / 9);
  EXPECT_EQ(whyUnanswerable(points), "all points are at one position, up to the rounding of their coordinates");
}

TEST(WhyUnanswerable, KnowsLinesUpToRounding) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Points points = line(100, seed);
    for (const float scale : {1e-12f, 1.0f, 1e12f})
      EXPECT_EQ(whyUnanswerable(points * scale), "all points lie on one line") << seed << ", scale " << scale;
    for (const double distance : {10.0, 1e3, 1e5})
      EXPECT_EQ(whyUnanswerable(line(100, seed, {distance, -distance, 0.3 * distance})), "all points lie on one line")
          << seed << ", " << distance << " away";
  }
}

TEST(WhyUnanswerable, LeavesThinThingsAlone) {
  // A millionth of the length of 2 is 2e-6: one point 1e-5 off the line makes it more than a line.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Points points = line(100, seed);
    const Eigen::Vector3f along = points.col(0) - points.col(1);
    points.col(50) += 1e-5f * along.unitOrthogonal();
    EXPECT_EQ(whyUnanswerable(points), "") << seed;
  }
  EXPECT_EQ(whyUnanswerable(box({1.0, 0.6, 0.0}, 100, Sampling::Random, 2).cloud()), "");
}

TEST(WhyUnanswerable, RefusesValuesThatAreNotFinite) {
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (const int num_points : {1, 100}) {
      Points points = box(num_points, Sampling::Random, 3).cloud();
      points(2, num_points - 1) = value;
      EXPECT_THROW(whyUnanswerable(points), std::invalid_argument) << num_points;
    }
  }
}

}  // namespace
