/// Where a cloud ends before a piece of its reflection.
#include "core/evidence/missing_surface.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/geometry/surface_normals.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// Those of the points that lie between two heights.
Points between(const Points& points, float low, float high) {
  Points kept(3, points.cols());
  Eigen::Index size = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    if (points(2, i) >= low && points(2, i) < high) kept.col(size++) = points.col(i);
  kept.conservativeResize(3, size);
  return kept;
}

float explained(const Points& points, const Points& piece, double spacing) {
  const auto search = makeFlannSearch(points);
  return beyondEnd(OutermostPoints(points), localGeometry(points, *search, kNumSupportNeighbours, 1).normals,
                   OutermostPoints(piece), spacing);
}

/// A plate of half the size 1 x 1 x half_height: both faces and its four sides.
Points plate(double half_height, std::uint64_t seed) {
  return box({1.0, 1.0, half_height}, 8000, Sampling::Random, seed).cloud();
}

constexpr double kSphereSpacing = 0.04;  // 1 / sqrt(density) of 8000 points on the unit sphere

TEST(SurfaceEnd, ExplainsWhatLiesBeyondACut) {
  const Points ball = sphere(8000, 1).cloud();
  for (const float height : {-0.3f, 0.0f, 0.4f})
    EXPECT_EQ(explained(between(ball, -2.0f, height), between(ball, height + 0.03f, 2.0f), kSphereSpacing), 1.0f)
        << height;
}

TEST(SurfaceEnd, DoesNotExplainWhatStandsOnAClosedSurface) {
  const Points ball = sphere(8000, 1).cloud();
  Points bump = between(sphere(2000, 2).cloud(), -0.5f, 2.0f);
  bump *= 0.2f;
  bump.row(2).array() += 1.15f;
  EXPECT_EQ(explained(ball, bump, kSphereSpacing), 0.0f);
}

TEST(SurfaceEnd, DoesNotExplainWhatReachesIntoTheCloud) {
  const Points ball = sphere(8000, 1).cloud();
  EXPECT_EQ(explained(between(ball, -2.0f, 0.4f), between(ball, 0.0f, 2.0f), kSphereSpacing), 0.0f);
}

TEST(SurfaceEnd, IsSeenOfPlatesThinnerThanTheSpacing) {
  Points thin = plate(0.01, 3);  // spacing of both faces together: 0.03
  std::swap_ranges(thin.row(0).begin(), thin.row(0).end(), thin.row(2).begin());
  EXPECT_EQ(explained(between(thin, -2.0f, 0.5f), between(thin, 0.53f, 2.0f), 0.03), 1.0f);
}

TEST(SurfaceEnd, IsNotTheFaceOfABlock) {
  const Points block = plate(0.5, 4);
  Points above = block;
  above.row(2).array() += 1.03f;
  EXPECT_EQ(explained(block, above, 0.04), 0.0f);
}

}  // namespace
