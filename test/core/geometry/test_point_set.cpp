/// Sets of points, the greatest distance in them, their subsets, and stray points.
#include "pcl_symmetry/core/point_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "core/base/random.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/point_samples.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(BoundingBall, HoldsEveryPointAndIsNearlyTheSmallest) {
  for (std::uint64_t pose = 0; pose < 5; ++pose) {
    // The corners of a box lie on its smallest ball.
    Eigen::Matrix3Xd corners(3, 8);
    for (int s = 0; s < 8; ++s)
      corners.col(s) = Eigen::Vector3d(s & 1 ? 1 : -1, s & 2 ? 0.7 : -0.7, s & 4 ? 0.45 : -0.45);
    const Points points = moved({corners, {}}, randomPose(pose)).cloud();
    const BoundingBall ball = boundingBall(points);
    const double smallest = Eigen::Vector3d(1.0, 0.7, 0.45).norm();
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      EXPECT_LE((points.col(i).cast<double>() - ball.center).norm(), ball.radius * (1.0 + 1e-12));
    EXPECT_GE(ball.radius, smallest * (1.0 - 1e-6));
    EXPECT_LE(ball.radius, smallest * 1.02);
    EXPECT_LT((ball.center - randomPose(pose).translation()).norm(), 0.05);
  }
}

TEST(BoundingBall, OfOnePositionAndOfPointsThatAreNotFinite) {
  const BoundingBall of_one = boundingBall(Points::Constant(3, 4, 2.5f));
  EXPECT_EQ(of_one.radius, 0.0);
  EXPECT_EQ(of_one.center, Eigen::Vector3d::Constant(2.5));
  EXPECT_EQ(boundingBall(Points(3, 0)).radius, 0.0);
  for (const float coordinate : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN(),
                                 std::numeric_limits<float>::infinity()}) {
    Points points = Points::Random(3, 4);
    points(1, 2) = coordinate;
    EXPECT_FALSE(boundingBall(points).center.allFinite()) << coordinate;
  }
}

TEST(CenterOfMass, IsTheMeanFarFromTheOrigin) {
  Points points(3, 3);
  points << 1e6f, 1e6f + 1.0f, 1e6f + 2.0f, -3.0f, 0.0f, 3.0f, 5.0f, 5.0f, 5.0f;
  EXPECT_LT((centerOfMass(points) - Eigen::Vector3d(1e6 + 1.0, 0.0, 5.0)).norm(), 1e-9);
  EXPECT_EQ(centerOfMass(Points(3, 0)), Eigen::Vector3d::Zero());
}

double diameterByAllPairs(const Points& points) {
  double sq_greatest = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      sq_greatest = std::max(sq_greatest, (points.col(i).cast<double>() - points.col(j).cast<double>()).squaredNorm());
  return std::sqrt(sq_greatest);
}

TEST(FarthestPair, IsTheDiameterOfMostShapesAndNeverMuchLess) {
  for (const Shape& shape : {cylinder(2000, 2), box(2000, Sampling::Random, 3), scaleneTetrahedron(2000, 4)}) {
    const Points points = moved(shape, randomPose(6)).cloud();
    EXPECT_NEAR(approximateDiameter(points), diameterByAllPairs(points), 1e-2 * diameterByAllPairs(points));
  }
  const Points round = sphere(2000, 1).cloud();
  EXPECT_LE(approximateDiameter(round), diameterByAllPairs(round));
  EXPECT_GE(approximateDiameter(round), diameterByAllPairs(round) / std::sqrt(3.0));
  EXPECT_EQ(approximateDiameter(Points(3, 0)), 0.0);
  EXPECT_EQ(approximateDiameter(Points::Ones(3, 100)), 0.0);
}

TEST(DistinctPoints, KeepsTheFirstCopyOfEachPositionInOrder) {
  const Points originals = asymmetricBlob(500, 3).cloud();
  RandomStream random(5);
  Points all(3, 3000);
  std::vector<int> first_at(originals.cols(), -1), expected_of, kept;
  for (Eigen::Index i = 0; i < all.cols(); ++i) {
    const auto k = static_cast<int>(random.below(originals.cols()));
    all.col(i) = originals.col(k);
    if (first_at[k] < 0) {
      first_at[k] = static_cast<int>(kept.size());
      kept.push_back(k);
    }
    expected_of.push_back(first_at[k]);
  }
  const DistinctPoints distinct(all);
  EXPECT_EQ(distinct.index_of, expected_of);
  ASSERT_EQ(distinct.points.cols(), static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i)
    EXPECT_EQ(distinct.points.col(static_cast<Eigen::Index>(i)), originals.col(kept[i]));
}

TEST(DistinctPoints, TakesBothZerosForOne) {
  Points all = Points::Zero(3, 3);
  all(1, 1) = -0.0f;
  all(2, 2) = 1.0f;
  const DistinctPoints distinct(all);
  EXPECT_EQ(distinct.index_of, (std::vector<int>{0, 0, 1}));
  EXPECT_EQ(distinct.points.cols(), 2);
  EXPECT_EQ(DistinctPoints(Points(3, 0)).points.cols(), 0);
}

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
  EXPECT_EQ(whyUnanswerable(Points(3, 0)), "no finite point");
}

TEST(WhyUnanswerable, KnowsOnePosition) {
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

TEST(SpreadSubset, KeepsDifferentPoints) {
  const Points points = moved(box(20'000, Sampling::Random, 1), randomPose(2)).cloud();
  const std::vector<int> kept = spreadSubset(points, 3000, 1);
  EXPECT_EQ(kept.size(), 3000u);
  EXPECT_EQ(std::set<int>(kept.begin(), kept.end()).size(), 3000u);
}

TEST(SpreadSubset, KeepsTheShareOfEachSide) {
  // Nine of ten points lie above: chance would keep 200 +- 13 of 2000 below.
  Points points(3, 20'000);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto x = static_cast<float>(i % 141) / 141.0f, y = static_cast<float>(i / 141) / 142.0f;
    points.col(i) << x, y, i % 10 == 0 ? -1.0f : 1.0f;
  }
  const std::vector<int> kept = spreadSubset(points, 2000, 3);
  const auto below = std::count_if(kept.begin(), kept.end(), [&](int i) { return points(2, i) < 0.0f; });
  EXPECT_NEAR(static_cast<double>(below), 200.0, 10.0);
}

TEST(SpreadSubset, OfPointsAtOnePositionOrOnALine) {
  EXPECT_EQ(spreadSubset(Points::Ones(3, 100), 10, 1).size(), 10u);
  const Points line = Eigen::Vector3f(1.0f, 2.0f, 2.0f) * Eigen::RowVectorXf::LinSpaced(1001, -1.0f, 1.0f);
  EXPECT_EQ(spreadSubset(line, 100, 1).size(), 100u);
}

/// Points at 2 to 20 sizes from the middle of a cloud, in random directions.
Points aboutCloud(const Points& cloud, int count, std::uint64_t seed) {
  RandomStream random(seed);
  const double size = approximateDiameter(cloud);
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

/// Outliers of photogrammetry: most lie beside the shape, not far from it.
TEST(StrayPoints, HardlyMoveTheDiameterWhereTheyFillABox) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Points cloud = (seed % 2 ? box(10'000, Sampling::Random, seed) : asymmetricBlob(10'000, seed)).cloud();
    const double size = diagonal(cloud);
    for (const int count : {1, 5, 20}) {
      RandomStream random(seed);
      Points outliers(3, count);
      for (float& x : outliers.reshaped()) x = static_cast<float>(0.7 * size * symmetric(random));
      const Points kept =
          withoutStrayPoints(joined(cloud, Points(outliers.colwise() + centerOfMass(cloud).cast<float>())));
      EXPECT_LT(approximateDiameter(kept), 1.15 * approximateDiameter(cloud)) << count << " outliers, seed " << seed;
    }
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
