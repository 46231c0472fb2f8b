/// Walks from neighbor to neighbor, against FLANN.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/geometry/flann_search.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// Points, their lists, and a walk and FLANN over them.
struct Searches {
  explicit Searches(const Points& cloud) : points(cloud), flann(points), lists(listsOf(points, flann)) {}

  static NeighborLists listsOf(const Points& points, const FlannSearch& flann) {
    constexpr int kCount = NeighborLists::kNeighbors + 1;
    std::vector<int> nearest;
    std::vector<float> sq_distances, sq_reach;
    flann.search(points, kCount, nearest, sq_distances);
    for (Eigen::Index i = 0; i < points.cols(); ++i) sq_reach.push_back(sq_distances[kCount * i + kCount - 1]);
    return NeighborLists(points, nearest, sq_reach, 1);
  }

  Points points;
  FlannSearch flann;
  NeighborLists lists;
};

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
  const Searches searches(points);
  const NeighborWalk walk(searches.lists, searches.flann);
  // 4000 points on a box of about 2 x 2 x 1 are 0.06 apart.
  for (const float distance : {0.002f, 0.15f}) {
    const Points queries = near(points, distance);
    std::vector<int> walked(points.cols(), -1), closest(points.cols(), -1);
    std::vector<float> sq_walked, sq_closest;
    constexpr float kFar = 1.0f;
    walk.searchWithin(queries, kFar, walked, sq_walked);
    searches.flann.searchWithin(queries, kFar, closest, sq_closest);
    int num_same = 0;
    double excess = 0.0;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      ASSERT_GE(walked[i], 0);
      // derived: four roundings, which vector instructions leave out or not
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
  const Searches searches(points);
  const NeighborWalk walk(searches.lists, searches.flann);
  const Points queries = near(points, 0.1f);
  std::vector<int> within(points.cols(), -1);
  std::vector<float> sq_distances;
  constexpr float kLimit = 0.004f;
  walk.searchWithin(queries, kLimit, within, sq_distances);
  int num_within = 0;
  for (std::size_t i = 0; i < within.size(); ++i) {
    num_within += within[i] >= 0 ? 1 : 0;
    if (within[i] >= 0)
      EXPECT_LE(sq_distances[i], kLimit);
    else
      EXPECT_EQ(sq_distances[i], std::numeric_limits<float>::infinity());
  }
  EXPECT_GT(num_within, 0);
  EXPECT_LT(num_within, 2000);
  std::vector<int> exact, of_walk;
  searches.flann.search(queries, 3, exact, sq_distances);
  walk.search(queries, 3, of_walk, sq_distances);
  EXPECT_EQ(exact, of_walk);
}

/// A walk as its description has it, one neighbor after the other.
std::pair<int, float> walkedAlone(const Searches& searches, const Eigen::Vector3f& query, int at) {
  constexpr int kCount = NeighborLists::kNeighbors + 1;
  std::vector<int> nearest;
  std::vector<float> sq_distances;
  const auto sqDistance = [&](int i) {
    const Eigen::Vector3f d = query - searches.points.col(i);
    return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
  };
  while (true) {
    searches.flann.search(searches.points.col(at), kCount, nearest, sq_distances);
    const int closest =
        *std::min_element(nearest.begin(), nearest.end(), [&](int a, int b) { return sqDistance(a) < sqDistance(b); });
    if (closest == at) return {at, sqDistance(at)};
    at = closest;
  }
}

TEST(NeighborLists, QueriesWalkSideBySideAsEachWouldAlone) {
  const Points points = box(1500, Sampling::Random, 8).cloud();
  if (!NeighborLists::isUseful(points.cols())) GTEST_SKIP() << "no lists on this processor";
  const Searches searches(points);
  // More queries than walk at a time, in every second column of a matrix.
  const Points queries = near(points, 0.1f);
  Eigen::Matrix3Xf apart = Eigen::Matrix3Xf::Zero(3, 2 * queries.cols());
  for (Eigen::Index i = 0; i < queries.cols(); ++i) apart.col(2 * i) = queries.col(i);
  const Eigen::Map<const Eigen::Matrix3Xf, 0, Eigen::OuterStride<>> spread(apart.data(), 3, queries.cols(),
                                                                           Eigen::OuterStride<>(6));
  std::vector<int> guesses(points.cols());
  for (std::size_t i = 0; i < guesses.size(); ++i) guesses[i] = static_cast<int>((i + 3 * (i % 5)) % guesses.size());
  std::vector<int> closest(guesses.size(), -1);
  std::vector<float> sq_closest;
  const std::vector<NeighborLists::Found> found = searches.lists.search(spread, guesses);
  searches.flann.searchWithin(queries, 1e6f, closest, sq_closest);
  int num_decided = 0;
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    const auto [end, sq_end] = walkedAlone(searches, queries.col(static_cast<Eigen::Index>(i)), guesses[i]);
    EXPECT_EQ(found[i].index, end) << i;
    EXPECT_FLOAT_EQ(found[i].sq_distance, sq_end) << i;
    if (!found[i].is_closest) continue;
    ++num_decided;
    EXPECT_EQ(found[i].index, closest[i]) << i;
  }
  EXPECT_GT(num_decided, 0);
}

}  // namespace
