#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <stdexcept>

#include "pcl_symmetry/core/symmetric_completion.h"
#include "shapes/scans.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

const ReflectionPlane kMiddle(Eigen::Vector3d::UnitX(), 0.0);

TEST(SymmetricCompletion, AddsTheHiddenHalfOfAScan) {
  const Scan scan = test::scan(blockChair(), {6.0, -3.0, 3.0});
  const Points points = scan.cloud();
  const Visibility visibility = scan.visibility();
  const std::vector<int> completing = completingPoints(points, kMiddle, {}, &visibility);
  ASSERT_GT(completing.size(), static_cast<std::size_t>(points.cols()) / 20) << "the left side was not seen";
  ASSERT_LT(completing.size(), static_cast<std::size_t>(points.cols())) << "the top of the seat was";
  EXPECT_EQ(std::adjacent_find(completing.begin(), completing.end(), std::greater_equal<int>()), completing.end());
  for (const int i : completing)
    EXPECT_GT(visibility.depthBehind(kMiddle.reflect(points.col(i).cast<double>())), -0.2)
        << "not in front of what was seen";
}

TEST(SymmetricCompletion, AddsNothingToAWhole) {
  const Shape shape = box(4000, Sampling::Mirrored, 1);
  EXPECT_TRUE(completingPoints(shape.cloud(), shape.planes[0]).empty());
}

TEST(SymmetricCompletion, AddsNothingInFreeSpace) {
  // A plane beside the object that the scanner looked at from the front: its reflection would stand in plain view.
  const Scan scan = test::scan(blockBox(), {0.0, -6.0, 0.0});
  const Points points = scan.cloud();
  const std::optional<Visibility> visibility = Visibility::fromPoints(points, scan.viewpoint);
  ASSERT_TRUE(visibility);
  const ReflectionPlane beside(Eigen::Vector3d::UnitX(), 1.2);
  EXPECT_TRUE(completingPoints(points, beside, {}, &*visibility).empty());
  EXPECT_EQ(completingPoints(points, beside).size(), static_cast<std::size_t>(points.cols()))
      << "without a viewpoint nothing speaks against it";
}

TEST(SymmetricCompletion, TakesAnyNumberOfPoints) {
  EXPECT_TRUE(completingPoints(Points(3, 0), kMiddle).empty());
  Points one(3, 1);
  one << 1, 0, 0;
  EXPECT_EQ(completingPoints(one, kMiddle).size(), 1u);
  one.setZero();
  EXPECT_TRUE(completingPoints(one, kMiddle).empty()) << "on the plane";
}

TEST(SymmetricCompletion, RefusesOptionsOutOfRange) {
  const Points points = box(100, Sampling::Random, 1).cloud();
  CompletionOptions overlap, margin, threads;
  overlap.overlap = 0.0;
  margin.margin = -1.0;
  threads.num_threads = -1;
  for (const CompletionOptions& options : {overlap, margin, threads})
    EXPECT_THROW(completingPoints(points, kMiddle, options), std::invalid_argument);
}

}  // namespace
