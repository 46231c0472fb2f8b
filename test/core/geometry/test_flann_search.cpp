#include "core/geometry/flann_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
    const Eigen::Vector3f move(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    queries.col(i) = points.col(i / 4) + off * move;
  }
  return queries;
}

TEST(FlannSearch, GivesTheSameAnswersWithLists) {
  for (const auto& [name, points] : pointSets()) {
    if (!NeighborLists::isUseful(points.cols())) continue;
    FlannSearch search(points);
    std::vector<int> nearest;
    std::vector<float> sq_nearest, sq_reach;
    constexpr int kCount = NeighborLists::kNeighbors + 1;
    search.search(points, kCount, nearest, sq_nearest);
    for (std::size_t i = kCount - 1; i < sq_nearest.size(); i += kCount) sq_reach.push_back(sq_nearest[i]);
    search.use(NeighborLists(points, nearest, sq_reach));
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
  constexpr int kCount = NeighborLists::kNeighbors + 1;
  std::vector<int> indices;
  std::vector<float> sq_distances, sq_reach;
  search.search(points, kCount, indices, sq_distances);
  for (std::size_t i = kCount - 1; i < sq_distances.size(); i += kCount) sq_reach.push_back(sq_distances[i]);
  if (NeighborLists::isUseful(points.cols())) search.use(NeighborLists(points, indices, sq_reach));
  const Points queries = Points::Constant(3, 4, std::numeric_limits<float>::quiet_NaN());
  for (const int count : {1, kCount}) {
    search.search(queries, count, indices, sq_distances);
    for (const int i : indices) EXPECT_TRUE(i >= 0 && i < points.cols()) << i;
  }
  std::vector<int> guesses{0, 1, 2, -1};
  search.searchWithin(queries, 1.0f, guesses, sq_distances);
  EXPECT_EQ(guesses, std::vector<int>(4, -1));
}

}  // namespace
