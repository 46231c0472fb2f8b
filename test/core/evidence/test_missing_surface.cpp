/// Where clouds end: open borders, planes of cuts, and counterparts that are missing.
#include "core/evidence/missing_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/constants.h"
#include "core/evidence/cut_planes.h"
#include "core/evidence/plane_support.h"
#include "core/geometry/open_borders.h"
#include "core/geometry/surface_normals.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using namespace test;

struct Surface {
  explicit Surface(const Points& input)
      : points(input),
        search(makeFlannSearch(points)),
        geometry(localGeometry(points, *search, kNumSupportNeighbours, 1)),
        borders(openBorders(points, *search, geometry.normals, 1)) {}

  double borderShare() const {
    return std::accumulate(borders.begin(), borders.end(), 0.0) / static_cast<double>(borders.size());
  }

  Points points;
  ClosestPointSearch::Ptr search;
  LocalGeometry geometry;
  std::vector<char> borders;
};

/// Points of a sphere below a height.
Points cap(double height) {
  return pointsWhere(sphere(8000, 3).cloud(), [&](const Eigen::Vector3f& x) { return x.z() < height; });
}

/// Means over the points: mapped onto the surface within 0.05, and missing.
std::pair<double, double> matchedAndMissing(const Surface& surface, const ReflectionPlane& plane) {
  Points reflected(3, surface.points.cols());
  for (Eigen::Index i = 0; i < reflected.cols(); ++i)
    reflected.col(i) = plane.reflect(surface.points.col(i).cast<double>()).cast<float>();
  std::vector<int> closest;
  std::vector<float> sq_distances;
  surface.search->search(reflected, 1, closest, sq_distances);
  std::vector<char> matched(closest.size());
  for (std::size_t i = 0; i < matched.size(); ++i) matched[i] = sq_distances[i] < 0.05 * 0.05;
  const double spacing = std::sqrt(4.0 * kPi / 8000.0);
  const std::vector<float> missing = missingCounterparts(
      {OutermostPoints(surface.points), surface.geometry, surface.borders, spacing}, matched, closest, reflected);
  const double count = static_cast<double>(matched.size());
  return {std::accumulate(matched.begin(), matched.end(), 0.0) / count,
          std::accumulate(missing.begin(), missing.end(), 0.0) / count};
}

TEST(OpenBorders, AreNearEverywhereOnAWireAndNowhereOnAClosedSurface) {
  const Surface closed(cap(2.0)), cut(cap(0.3));
  EXPECT_LT(shareNearBorders(closed.borders, closed.geometry), 0.25);
  EXPECT_LT(shareNearBorders(cut.borders, cut.geometry), 0.4);
  Points arc(3, 300);
  for (Eigen::Index i = 0; i < arc.cols(); ++i) {
    const double angle = 0.01 * static_cast<double>(i);
    arc.col(i) = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.1 * angle).cast<float>();
  }
  const Surface wire(arc);
  EXPECT_GT(shareNearBorders(wire.borders, wire.geometry), 0.95);
}

TEST(OpenBorders, OfAClosedSurfaceAreRareAndOfACutOneFollowTheCut) {
  EXPECT_LT(Surface(cap(2.0)).borderShare(), 0.03);
  const Surface cut(cap(0.3));
  double along_cut = 0.0, num_along_cut = 0.0;
  for (Eigen::Index i = 0; i < cut.points.cols(); ++i) {
    if (cut.points(2, i) < 0.28f) continue;
    along_cut += cut.borders[i];
    ++num_along_cut;
  }
  EXPECT_GT(along_cut / num_along_cut, 0.6);
}

TEST(OpenBorders, AreNotAtTheEdgesOfABox) {
  EXPECT_LT(Surface(box(8000, Sampling::Random, 4).cloud()).borderShare(), 0.05);
}

TEST(MissingCounterparts, ExplainWhatWasCutOff) {
  // z = 0 maps the piece below z = -0.3 to where the sphere was cut off.
  const Surface cut(cap(0.3));
  const auto [matched, missing] = matchedAndMissing(cut, ReflectionPlane(Eigen::Vector3d::UnitZ(), 0.0));
  EXPECT_NEAR(matched, 0.6 / 1.3, 0.06);  // the zone from -0.3 to 0.3, by area, and the tolerance beyond it
  EXPECT_NEAR(matched + missing, 1.0, 0.03);
}

TEST(MissingCounterparts, ExplainAPartWithoutAnEdge) {
  // Two spheres, and nothing between them. x = 0 maps a third one, at the left, to where the cloud was cut off.
  const Points ball = cap(2.0);
  Points points(3, 0);
  const auto add = [&](double x, bool is_cut) {
    for (Eigen::Index i = 0; i < ball.cols(); ++i) {
      if (is_cut && ball(0, i) > 0.2f) continue;
      points.conservativeResize(3, points.cols() + 1);
      points.col(points.cols() - 1) = ball.col(i) + Eigen::Vector3f(static_cast<float>(x), 0.0f, 0.0f);
    }
  };
  add(1.2, true);
  add(-1.2, false);
  add(-4.0, false);
  const auto [matched, missing] = matchedAndMissing(Surface(points), ReflectionPlane(Eigen::Vector3d::UnitX(), 0.0));
  EXPECT_LT(matched, 0.6);
  EXPECT_NEAR(matched + missing, 1.0, 0.03);
}

TEST(MissingCounterparts, DoNotExcuseWhatOneSideHasAndTheOtherHasNot) {
  // A bump on a closed sphere has no counterpart below, and nothing ends there.
  Points points = cap(2.0);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const float off = std::max(0.0f, 0.3f - (points.col(i) - Eigen::Vector3f::UnitZ()).norm());
    points.col(i) *= 1.0f + off;
  }
  const auto [matched, missing] = matchedAndMissing(Surface(points), ReflectionPlane(Eigen::Vector3d::UnitZ(), 0.0));
  EXPECT_LT(matched, 0.98);
  EXPECT_LT(missing, 0.3 * (1.0 - matched));
}

/// Those of the points that lie between two heights.
Points between(const Points& points, float low, float high) {
  return pointsWhere(points, [&](const Eigen::Vector3f& x) { return x.z() >= low && x.z() < high; });
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

/// Those of the points that lie before a plane.
Points before(const Points& points, const Eigen::Vector3f& normal, float offset) {
  return pointsWhere(points, [&](const Eigen::Vector3f& x) { return normal.dot(x) < offset; });
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
}  // namespace pcl_symmetry
