#include "pcl_symmetry/core/closest_point_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

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
    std::vector<float> expected(points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i) expected[i] = (points.col(i) - queries.col(q)).squaredNorm();
    std::vector<float> sorted = expected;
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
  /// Only search(): searchWithin() is that of the base class.
  struct Plain : ClosestPointSearch {
    explicit Plain(const Points& points) : all(makeFlannSearch(points)) {}
    void search(const PointsRef& queries, int num_neighbors, std::vector<int>& indices,
                std::vector<float>& sq_distances) const override {
      all->search(queries, num_neighbors, indices, sq_distances);
    }
    Ptr all;
  };
  const Points points = asymmetricBlob(700, 2).cloud();
  const Points queries = asymmetricBlob(100, 3).cloud();
  std::vector<int> closest;
  std::vector<float> closest_sq;
  makeFlannSearch(points)->search(queries, 1, closest, closest_sq);
  std::vector<float> sorted = closest_sq;
  std::sort(sorted.begin(), sorted.end());
  const float limit = sorted[50];
  std::vector<int> far(100);
  for (int i = 0; i < 100; ++i) far[i] = 7 * i;
  const std::vector<ClosestPointSearch::Ptr> searches{makeFlannSearch(points), std::make_shared<Plain>(points)};
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

}  // namespace
