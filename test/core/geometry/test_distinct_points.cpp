#include "core/geometry/distinct_points.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
}

TEST(DistinctPoints, LeavesDifferentPointsAlone) {
  const Points points = asymmetricBlob(2000, 4).cloud();
  const DistinctPoints distinct(points);
  EXPECT_EQ(distinct.points, points);
  EXPECT_EQ(DistinctPoints(Points(3, 0)).points.cols(), 0);
}

}  // namespace
