/// Walks from neighbor to neighbor, against FLANN.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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
    return NeighborLists(points, nearest, sq_reach);
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

}  // namespace
