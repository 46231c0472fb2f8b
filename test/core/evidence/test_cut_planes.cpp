/// Planes at which clouds were cut off.
#include "core/evidence/cut_planes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/evidence/plane_support.h"
#include "core/geometry/open_borders.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// Those of the points that lie before a plane.
Points before(const Points& points, const Eigen::Vector3f& normal, float offset) {
  Points kept(3, points.cols());
  Eigen::Index size = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (normal.dot(points.col(i)) < offset) kept.col(size++) = points.col(i);
  kept.conservativeResize(3, size);
  return kept;
}

double spacingOf(const Points& points, double area) {
  return std::sqrt(area / static_cast<double>(points.cols()));
}

std::vector<CutPlane> cutsOf(const Points& points, double spacing) {
  const auto search = makeFlannSearch(points);
  const LocalGeometry geometry = localGeometry(points, *search, kNumSupportNeighbours, 1);
  return findCutPlanes(points, openBorders(points, *search, geometry.normals, 1), spacing, 1);
}

TEST(CutPlanes, AreFoundWhereTheCloudWasCut) {
  const Points whole = sphere(8000, 1).cloud();
  const double spacing = spacingOf(whole, 4.0 * kPi);
  const Eigen::Vector3f normal = Eigen::Vector3f(0.3f, -0.5f, 0.8f).normalized();
  for (const float offset : {0.2f, 0.6f}) {
    const std::vector<CutPlane> cuts = cutsOf(before(whole, normal, offset), spacing);
    ASSERT_EQ(cuts.size(), 1u) << offset;
    EXPECT_GT(cuts[0].normal.dot(normal), std::cos(0.05f));  // border points are off by a spacing, 0.04
    EXPECT_NEAR(cuts[0].offset, offset, 1.5 * spacing);
  }
}

TEST(CutPlanes, EachCutIsFound) {
  const Points whole = sphere(8000, 1).cloud();
  const Points twice = before(before(whole, Eigen::Vector3f::UnitZ(), 0.5f), Eigen::Vector3f::UnitX(), 0.6f);
  EXPECT_EQ(cutsOf(twice, spacingOf(whole, 4.0 * kPi)).size(), 2u);
}

TEST(CutPlanes, ClosedSurfacesHaveNone) {
  const Points ball = sphere(8000, 2).cloud(), block = box(8000, Sampling::Random, 3).cloud();
  EXPECT_TRUE(cutsOf(ball, spacingOf(ball, 4.0 * kPi)).empty());
  EXPECT_TRUE(cutsOf(block, 0.03).empty());
}

TEST(CutPlanes, TheEdgesOfASheetFixNone) {
  Points sheet(3, 4000);
  RandomStream random(4);
  for (Eigen::Index i = 0; i < sheet.cols(); ++i)
    sheet.col(i) = Eigen::Vector3d(symmetric(random), symmetric(random), 0.0).cast<float>();
  EXPECT_TRUE(cutsOf(sheet, spacingOf(sheet, 4.0)).empty());
}

TEST(CutPlanes, FewPointsHaveNone) {
  EXPECT_TRUE(findCutPlanes(Points(3, 0), {}, 0.1, 1).empty());
  EXPECT_TRUE(findCutPlanes(Points::Random(3, 10), std::vector<char>(10, 1), 0.1, 1).empty());
}

}  // namespace
