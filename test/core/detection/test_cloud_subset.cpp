/// Large clouds: planes and support by the points that stand for them.
#include "core/detection/cloud_subset.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(CloudSubset, TakesAsManyPointsAsTheToleranceNeeds) {
  const Points points = box(90'000, Sampling::Random, 1).cloud();
  DetectionOptions options;
  EXPECT_EQ(subsetOf(points, options)->kept.size(), 20'000u);
  options.tolerance = 0.005;  // half of the spacing: four times as many
  EXPECT_EQ(subsetOf(points, options)->kept.size(), 80'000u);
  options.tolerance = 0.002;
  EXPECT_FALSE(subsetOf(points, options));
  EXPECT_FALSE(subsetOf(points.leftCols(20'000), DetectionOptions()));
}

TEST(CloudSubset, LeavesCloudsOfFewDistinctPoints) {
  const Points few = box(10'000, Sampling::Random, 1).cloud();
  Points copies(3, 5 * few.cols());
  for (int k = 0; k < 5; ++k) copies.middleCols(k * few.cols(), few.cols()) = few;
  EXPECT_FALSE(subsetOf(copies, DetectionOptions()));
}

TEST(CloudSubset, NamesAPointNearEach) {
  const Points points = moved(prism(5, 60'000, Sampling::Random, 2), randomPose(3)).cloud();
  const CloudSubset subset = *subsetOf(points, DetectionOptions());
  const std::vector<int> near = subset.nearTo(points, 1);
  const double size = diagonal(points);
  double worst = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const double distance = (points.col(static_cast<Eigen::Index>(i)) - subset.points.col(near[i])).norm();
    worst = std::max(worst, distance);
    sum += distance;
  }
  // Points of the subset are 1 % of the size apart, and the search takes over at an edge of a cell.
  EXPECT_LT(worst, size / 64.0 * 1.01);
  EXPECT_LT(sum / static_cast<double>(near.size()), 0.007 * size);
  EXPECT_EQ(near, subset.nearTo(points, 2));
}

TEST(CloudSubset, PlanesAndSupportAreOfTheWholeCloud) {
  const Shape shape = moved(box(60'000, Sampling::Random, 4), randomPose(5));
  const Points points = shape.cloud();
  const Detection detection = detectPlanes(points);
  ASSERT_EQ(detection.planes.size(), 3u);
  const Eigen::Vector3d center = centerOfMass(points);
  for (const SymmetryPlane& plane : detection.planes) {
    EXPECT_EQ(plane.kind, PlaneKind::Symmetry);
    PlaneError nearest{10.0, 0.0};
    for (const ReflectionPlane& expected : shape.planes) {
      const PlaneError error = planeError(plane, expected, center);
      if (error.angle < nearest.angle) nearest = error;
    }
    EXPECT_LT(nearest.angle, 0.1 * kDegree);
    EXPECT_LT(nearest.offset, 1e-3 * diagonal(points));
    ASSERT_EQ(plane.point_support.size(), 60'000u);
    double sum = 0.0;
    for (const float support : plane.point_support) sum += support;
    EXPECT_GT(sum / 60'000.0, 0.97);
  }
}

}  // namespace
