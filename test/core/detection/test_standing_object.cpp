/// Planes of what stands on a table.
#include "core/detection/plane_decision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/detection/plane_fit.h"

namespace pcl_symmetry {

namespace {

/// Points in a cube of unit side that stands at a height.
Points cubeAt(double height) {
  RandomStream random(1);
  Points points(3, 500);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    points.col(i) = Eigen::Vector3d(random.uniform(), random.uniform(), height + random.uniform()).cast<float>();
  return points;
}

Visibility seenFromAbove(const Points& points) {
  return *Visibility::ofScene(points, {0.5, 0.5, 6.0});
}

const Eigen::Vector4d kTable(0.0, 0.0, 1.0, 0.0), kWall(1.0, 0.0, 0.0, 0.0);

/// A plane whose normal is this far from the vertical, degrees, turned about it.
SymmetryPlane planeAt(double angle, double turn, double confidence) {
  const double a = angle * kPi / 180.0, t = turn * kPi / 180.0;
  SymmetryPlane plane(
      ReflectionPlane(Eigen::Vector3d(std::sin(a) * std::cos(t), std::sin(a) * std::sin(t), std::cos(a)), 0.5));
  plane.kind = PlaneKind::Symmetry;
  plane.confidence = confidence;
  return plane;
}

}  // namespace

TEST(StandingObject, PlanesSlantWhereTheyAreNeitherUprightNorLevel) {
  const Points points = cubeAt(0.0);
  const auto normals = carryingNormals(points, seenFromAbove(points).withSupport(kTable, 0.0));
  ASSERT_EQ(normals.size(), 1u);
  for (const double angle : {0.0, 4.0, 86.0, 90.0, 94.0, 176.0})
    for (const double turn : {0.0, 50.0}) EXPECT_FALSE(slants(planeAt(angle, turn, 0.9), normals)) << angle;
  for (const double angle : {6.0, 45.0, 84.0, 96.0, 150.0})
    for (const double turn : {0.0, 50.0}) EXPECT_TRUE(slants(planeAt(angle, turn, 0.9), normals)) << angle;
  EXPECT_FALSE(slants(planeAt(45.0, 0.0, 0.9), {})) << "nothing carries it";
}

TEST(StandingObject, ItStandsOnTheNearestSupport) {
  // The wall is one side away; then the cube touches both.
  Points points = cubeAt(0.0);
  points.row(0).array() += 1.0f;
  const Visibility seen = seenFromAbove(points).withSupport(kWall, 0.0).withSupport(kTable, 0.0);
  ASSERT_EQ(carryingNormals(points, seen).size(), 1u);
  EXPECT_EQ(carryingNormals(points, seen).front(), Eigen::Vector3d::UnitZ());
  const Points at_the_wall = cubeAt(0.0);
  const auto both =
      carryingNormals(at_the_wall, seenFromAbove(at_the_wall).withSupport(kWall, 0.0).withSupport(kTable, 0.0));
  ASSERT_EQ(both.size(), 2u);
  EXPECT_FALSE(slants(planeAt(90.0, 45.0, 0.9), both)) << "upright, and askew to the wall";
  EXPECT_TRUE(slants(planeAt(45.0, 45.0, 0.9), both));
  EXPECT_TRUE(carryingNormals(points, seenFromAbove(points)).empty());
}

TEST(StandingObject, SlantedPlanesAreDoubtedAndGoBehind) {
  const Points points = cubeAt(0.0);
  const GaussianEdt edt(points);
  DetectionOptions options;
  const auto doubted = [&](const Visibility& seen) {
    const NormalizedCloud cloud(points, edt, nullptr, &seen, 1);
    const auto fit = makePlaneFit(cloud, {IspUpdate::PointToPlane, 100, 1, 1, 1});
    std::vector<SymmetryPlane> planes = {planeAt(40.0, 0.0, 0.95), planeAt(90.0, 0.0, 0.7), planeAt(30.0, 0.0, 0.55)};
    PlaneJudge(cloud, *fit, options).decision.doubtSlanted(planes);
    return planes;
  };
  const Visibility on_table = seenFromAbove(points).withSupport(kTable, 0.0);
  std::vector<SymmetryPlane> planes = doubted(on_table);
  ASSERT_EQ(planes.size(), 2u) << "the last one is not even possible";
  EXPECT_EQ(planes[0].confidence, 0.7);
  EXPECT_EQ(planes[0].kind, PlaneKind::Symmetry);
  EXPECT_NEAR(planes[1].normal().z(), std::cos(40.0 * kPi / 180.0), 1e-6);
  EXPECT_EQ(planes[1].kind, PlaneKind::Symmetry) << "0.95 is sure enough";
  EXPECT_LT(planes[1].confidence, 0.7);
  EXPECT_EQ(doubted(seenFromAbove(points))[0].confidence, 0.95) << "nothing carries it";
  options.approximate = true;
  planes = doubted(on_table);
  ASSERT_EQ(planes.size(), 3u);
  EXPECT_EQ(planes[2].kind, PlaneKind::Approximate);
}

}  // namespace pcl_symmetry
