/// Closest points: the interface, FLANN, lists of neighbors and the grid.
#include "pcl_symmetry/core/closest_point_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/base/random.h"
#include "core/geometry/closest_points.h"
#include "shapes/counting_search.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(ClosestPointSearch, FindsWhatBruteForceFinds) {
  const Points points = moved(asymmetricBlob(700, 2), randomPose(2)).cloud();
  const auto search = makeFlannSearch(points);
  Points queries = moved(asymmetricBlob(100, 3), randomPose(2)).cloud();
  queries.col(7) = points.col(7);
  constexpr int kNum = 5;
  std::vector<int> indices;
  std::vector<float> sq_distances;
  search->search(queries, kNum, indices, sq_distances);
  ASSERT_EQ(indices.size(), 500u);
  ASSERT_EQ(sq_distances.size(), 500u);
  for (Eigen::Index q = 0; q < queries.cols(); ++q) {
    const Eigen::RowVectorXf expected = (points.colwise() - queries.col(q)).colwise().squaredNorm();
    Eigen::RowVectorXf sorted = expected;
    std::sort(sorted.begin(), sorted.end());
    for (int k = 0; k < kNum; ++k) {
      // The same sum of three squares, added in another order at most.
      EXPECT_NEAR(sq_distances[q * kNum + k], sorted[k], 3e-7f * sorted[k]);
      EXPECT_NEAR(expected[indices[q * kNum + k]], sorted[k], 3e-7f * sorted[k]);
    }
  }
  EXPECT_EQ(indices[7 * kNum], 7);
}

TEST(ClosestPointSearch, FindsWithinTheLimitWhateverWasGuessed) {
  AskedSearch plain;  // only search(): searchWithin() is that of the base class
  const Points points = asymmetricBlob(700, 2).cloud();
  const Points queries = asymmetricBlob(100, 3).cloud();
  const auto [closest, closest_sq] = closestPoints(*makeFlannSearch(points), queries, 1);
  std::vector<float> sorted = closest_sq;
  std::sort(sorted.begin(), sorted.end());
  const float limit = sorted[50];
  std::vector<int> far(100);
  for (int i = 0; i < 100; ++i) far[i] = 7 * i;
  const std::vector<ClosestPointSearch::Ptr> searches{makeFlannSearch(points), plain.make()(points)};
  for (const auto& search : searches) {
    for (const std::vector<int>& guesses : {std::vector<int>(100, -1), far, closest}) {
      std::vector<int> indices = guesses;
      std::vector<float> sq_distances;
      search->searchWithin(queries, limit, indices, sq_distances);
      ASSERT_EQ(sq_distances.size(), 100u);
      for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(indices[i], closest_sq[i] <= limit ? closest[i] : -1) << i;
        const float expected = indices[i] < 0 ? std::numeric_limits<float>::infinity() : closest_sq[i];
        EXPECT_FLOAT_EQ(sq_distances[i], expected) << i;
      }
    }
  }
}

TEST(ClosestPointSearch, TakesColumnsAtAnyDistance) {
  const Points points = box(200, Sampling::Random, 3).cloud();
  const Eigen::Matrix4Xf wide = points.colwise().homogeneous();
  const Eigen::Ref<const Eigen::Matrix3Xf, 0, Eigen::OuterStride<>> view(wide.topRows<3>());
  std::vector<int> indices;
  std::vector<float> sq_distances;
  makeFlannSearch(view)->search(view, 1, indices, sq_distances);
  for (int i = 0; i < 200; ++i) EXPECT_EQ(indices[i], i);
  makeFlannSearch(points)->search(Points(3, 0), 1, indices, sq_distances);
  EXPECT_TRUE(indices.empty());
}

struct NamedPoints {
  std::string name;
  Points points;
};

/// Points of a lattice: most distances between them occur many times.
Points lattice(int side) {
  Points points(3, side * side * side);
  for (int i = 0; i < points.cols(); ++i)
    points.col(i) = Eigen::Array3i(i % side, i / side % side, i / side / side).cast<float>() * 0.25f;
  return points;
}

std::vector<NamedPoints> pointSets() {
  const Points blob = moved(asymmetricBlob(3000, 5), randomPose(4)).cloud();
  Points copies(3, 60), spiral(3, 300);
  for (int i = 0; i < copies.cols(); ++i) copies.col(i) = blob.col(i / 20);
  // Each point is half as far from the origin as the one before: the tree is as deep as there are points.
  for (int i = 0; i < spiral.cols(); ++i)
    spiral.col(i) = std::ldexp(1.0f, -i / 3) * Eigen::Vector3f(i % 3 == 0, i % 3 == 1, i % 3 == 2);
  return {{"blob", blob}, {"lattice", lattice(9)}, {"copies", copies}, {"spiral", spiral}, {"one", blob.leftCols(1)}};
}

/// Positions on, near and far from the points.
Points queriesFor(const Points& points) {
  RandomStream random(3);
  const float extent = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
  Points queries(3, 4 * points.cols());
  for (Eigen::Index i = 0; i < queries.cols(); ++i) {
    const float off = i % 4 == 0 ? 0.0f : extent * std::pow(0.1f, static_cast<float>(i % 4 - 1));
    queries.col(i) = points.col(i / 4) + 0.5f * off * randomPoint(random).cast<float>();
  }
  return queries;
}

NeighborLists listsOf(const Points& points, const FlannSearch& search) {
  constexpr int kCount = NeighborLists::kNeighbors + 1;
  std::vector<int> nearest;
  std::vector<float> sq_distances, sq_reach;
  search.search(points, kCount, nearest, sq_distances);
  for (std::size_t i = kCount - 1; i < sq_distances.size(); i += kCount) sq_reach.push_back(sq_distances[i]);
  return NeighborLists(points, nearest, sq_reach);
}

TEST(FlannSearch, GivesTheSameAnswersWithLists) {
  for (const auto& [name, points] : pointSets()) {
    if (!NeighborLists::isUseful(points.cols())) continue;
    FlannSearch search(points);
    search.use(std::make_shared<NeighborLists>(listsOf(points, search)));
    const ClosestPointSearch::Ptr without = makeFlannSearch(points);
    const Points queries = queriesFor(points);
    const auto size = static_cast<std::size_t>(queries.cols());
    // Guesses anywhere, twice, and close ones: the point that the query was made from; none for every third query, and
    // for all.
    for (const int kind : {0, 1, 2, 3, 4}) {
      std::vector<int> guesses(size, -1);
      for (std::size_t i = 0; i < size && kind < 4; ++i)
        if (kind < 3 || i % 3 > 0)
          guesses[i] = static_cast<int>((kind >= 2 ? i / 4 : 7 * i + static_cast<std::size_t>(kind)) % points.cols());
      for (const float limit : {0.0f, 1e-4f, 0.0625f, 1e6f}) {
        std::vector<int> indices = guesses, expected = guesses;
        std::vector<float> sq_distances, expected_sq;
        search.searchWithin(queries, limit, indices, sq_distances);
        without->searchWithin(queries, limit, expected, expected_sq);
        EXPECT_EQ(indices, expected) << name << ", limit " << limit << ", guesses " << kind;
        EXPECT_EQ(sq_distances, expected_sq) << name << ", limit " << limit << ", guesses " << kind;
      }
    }
  }
}

TEST(FlannSearch, QueriesThatAreNoNumbersEndWithoutHarm) {
  const Points points = Points::Random(3, 500);
  FlannSearch search(points);
  if (NeighborLists::isUseful(points.cols())) search.use(std::make_shared<NeighborLists>(listsOf(points, search)));
  std::vector<int> indices;
  std::vector<float> sq_distances;
  const Points queries = Points::Constant(3, 4, std::numeric_limits<float>::quiet_NaN());
  for (const int count : {1, NeighborLists::kNeighbors + 1}) {
    search.search(queries, count, indices, sq_distances);
    for (const int i : indices) EXPECT_TRUE(i >= 0 && i < points.cols()) << i;
  }
  std::vector<int> guesses{0, 1, 2, -1};
  search.searchWithin(queries, 1.0f, guesses, sq_distances);
  EXPECT_EQ(guesses, std::vector<int>(4, -1));
}

/// Points at some distance of those of a cloud.
Points near(const Points& points, float distance) {
  RandomStream random(7);
  Points queries = points;
  for (Eigen::Index i = 0; i < queries.cols(); ++i) queries.col(i) += distance * randomDirection(random).cast<float>();
  return queries;
}

TEST(NeighborWalk, EndsAtTheClosestPointOnTheSurfaceAndNearItBeside) {
  const Points points = box(4000, Sampling::Random, 5).cloud();
  if (!NeighborLists::isUseful(points.cols())) GTEST_SKIP() << "no lists on this processor";
  const FlannSearch flann(points);
  const NeighborLists lists = listsOf(points, flann);
  const NeighborWalk walk(lists, flann);
  // 4000 points on a box of about 2 x 2 x 1 are 0.06 apart.
  for (const float distance : {0.002f, 0.15f}) {
    const Points queries = near(points, distance);
    std::vector<int> walked(points.cols(), -1), closest(points.cols(), -1);
    std::vector<float> sq_walked, sq_closest;
    constexpr float kFar = 1.0f;
    walk.searchWithin(queries, kFar, walked, sq_walked);
    flann.searchWithin(queries, kFar, closest, sq_closest);
    int num_same = 0;
    double excess = 0.0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      ASSERT_GE(walked[i], 0);
      // Four roundings, which vector instructions leave out or not
      EXPECT_FLOAT_EQ(sq_walked[i], (queries.col(i) - points.col(walked[i])).squaredNorm());
      EXPECT_GE(sq_walked[i], sq_closest[i] * (1.0f - 1e-6f));
      num_same += walked[i] == closest[i] ? 1 : 0;
      excess += std::sqrt(sq_walked[i]) - std::sqrt(sq_closest[i]);
    }
    EXPECT_GE(num_same, distance < 0.01f ? 0.97 * points.cols() : 0.6 * points.cols());
    EXPECT_LT(excess / static_cast<double>(points.cols()), 0.01);
  }
}

TEST(NeighborWalk, KeepsTheLimitAndTheExactSearch) {
  const Points points = box(2000, Sampling::Random, 6).cloud();
  if (!NeighborLists::isUseful(points.cols())) GTEST_SKIP() << "no lists on this processor";
  const FlannSearch flann(points);
  const NeighborLists lists = listsOf(points, flann);
  const NeighborWalk walk(lists, flann);
  const Points queries = near(points, 0.1f);
  std::vector<int> within(points.cols(), -1);
  std::vector<float> sq_distances;
  constexpr float kLimit = 0.004f;
  walk.searchWithin(queries, kLimit, within, sq_distances);
  int num_within = 0;
  for (std::size_t i = 0; i < within.size(); ++i) {
    num_within += within[i] >= 0 ? 1 : 0;
    EXPECT_TRUE(within[i] >= 0 ? sq_distances[i] <= kLimit : std::isinf(sq_distances[i])) << sq_distances[i];
  }
  EXPECT_GT(num_within, 0);
  EXPECT_LT(num_within, 2000);
  std::vector<int> exact, of_walk;
  flann.search(queries, 3, exact, sq_distances);
  walk.search(queries, 3, of_walk, sq_distances);
  EXPECT_EQ(exact, of_walk);
}

TEST(ClosestPointGrid, IsAsExactAsItsCells) {
  const Points points = asymmetricBlob(2000, 1).cloud();
  const ClosestPointGrid grid(points, 32);
  const double cell = 2.0 * 1.25 * boundingBall(points).radius / 32;
  RandomStream random(3);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f x = (1.5 * randomPoint(random)).cast<float>();
    const float least = std::sqrt((points.colwise() - x).colwise().squaredNorm().minCoeff());
    const float found = (points.col(grid.closest(x)) - x).norm();
    // x and its cell's center are half a diagonal apart at most; what the sweeps miss is far less than a cell.
    EXPECT_LE(found, least + 2.0 * 0.5 * std::sqrt(3.0) * cell + 0.1 * cell);
  }
}

TEST(ClosestPointGrid, AnswersFarOutsideAndForOnePoint) {
  const Points one = Points::Constant(3, 1, 2.0f);
  EXPECT_EQ(ClosestPointGrid(one, 32).closest({1e6f, -1e6f, 0.0f}), 0);
  Points two(3, 2);
  two << -1, 1, 0, 0, 0, 0;
  EXPECT_EQ(ClosestPointGrid(two, 32).closest({-50.0f, 3.0f, 3.0f}), 0);
  EXPECT_EQ(ClosestPointGrid(two, 32).closest({50.0f, 3.0f, 3.0f}), 1);
  EXPECT_THROW(ClosestPointGrid(Points(3, 0), 32), std::invalid_argument);
}

}  // namespace
