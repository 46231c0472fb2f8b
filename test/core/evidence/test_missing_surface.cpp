#include "core/evidence/missing_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/constants.h"
#include "core/geometry/open_borders.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
  Points points(3, 8000);
  RandomStream random(3);
  Eigen::Index size = 0;
  for (int i = 0; i < 8000; ++i) {
    Eigen::Vector3d x(gaussian(random), gaussian(random), gaussian(random));
    x.normalize();
    if (x.z() < height) points.col(size++) = x.cast<float>();
  }
  points.conservativeResize(3, size);
  return points;
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

}  // namespace
