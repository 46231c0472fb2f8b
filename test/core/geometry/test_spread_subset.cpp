/// A subset of a cloud that keeps the share of each neighborhood.
#include "core/geometry/spread_subset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(SpreadSubset, KeepsDifferentPointsAndNamesOneBesideEach) {
  const Points points = moved(box(20'000, Sampling::Random, 1), randomPose(2)).cloud();
  const SpreadSubset subset = spreadSubset(points, 3000, 1);
  EXPECT_EQ(subset.kept.size(), 3000u);
  EXPECT_EQ(std::set<int>(subset.kept.begin(), subset.kept.end()).size(), 3000u);
  ASSERT_EQ(subset.beside.size(), 20'000u);
  const auto [least, most] = std::minmax_element(subset.beside.begin(), subset.beside.end());
  EXPECT_GE(*least, 0);
  EXPECT_LT(*most, 3000);
  // Every kept point stands beside itself.
  for (std::size_t k = 0; k < subset.kept.size(); ++k)
    EXPECT_EQ(subset.beside[static_cast<std::size_t>(subset.kept[k])], static_cast<int>(k));
}

TEST(SpreadSubset, KeepsTheShareOfEachSide) {
  // Nine of ten points lie above: chance would keep 200 +- 13 of 2000 below.
  Points points(3, 20'000);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const auto x = static_cast<float>(i % 141) / 141.0f, y = static_cast<float>(i / 141) / 142.0f;
    points.col(i) << x, y, i % 10 == 0 ? -1.0f : 1.0f;
  }
  const SpreadSubset subset = spreadSubset(points, 2000, 3);
  const auto below = std::count_if(subset.kept.begin(), subset.kept.end(), [&](int i) { return points(2, i) < 0.0f; });
  EXPECT_NEAR(static_cast<double>(below), 200.0, 10.0);
}

TEST(SpreadSubset, OfPointsAtOnePlaceOrOnALine) {
  EXPECT_EQ(spreadSubset(Points::Ones(3, 100), 10, 1).kept.size(), 10u);
  const Points line = Eigen::Vector3f(1.0f, 2.0f, 2.0f) * Eigen::RowVectorXf::LinSpaced(1001, -1.0f, 1.0f);
  EXPECT_EQ(spreadSubset(line, 100, 1).kept.size(), 100u);
}

}  // namespace
