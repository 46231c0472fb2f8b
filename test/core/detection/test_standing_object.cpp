/// Planes of what stands on a table or a ground.
#include "core/detection/plane_decision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/detection/plane_fit.h"
#include "core/detection/upright_box.h"

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

const Eigen::Vector3d kFrom(-6.0, -9.0, 1.5);  // the scanner sees the sides at low x and at low y

/// Rows of points on two sides of a box of 4 x 2 x 1, turned about z.
Points twoSides(double turn) {
  Points points(3, 0);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto add = [&](const Eigen::Vector3d& x) {
    points.conservativeResize(3, points.cols() + 1);
    points.col(points.cols() - 1) = (R * x).cast<float>();
  };
  for (int ring = 0; ring < 6; ++ring) {
    const double z = 0.1 + 0.16 * ring;
    for (int i = 0; i <= 40; ++i) add({-2.0 + 0.1 * i, -1.0, z});
    for (int i = 1; i <= 20; ++i) add({-2.0, -1.0 + 0.1 * i, z});
  }
  return points;
}

TEST(MiddlePlaneOfBox, IsAlongTheLongerSideAndTurnsWithThePoints) {
  for (const double turn : {0.0, 0.4, 1.3, 2.9}) {
    const Eigen::AngleAxisd R(turn, Eigen::Vector3d::UnitZ());
    const auto plane = middlePlaneOfBox(twoSides(turn), {0.0, 0.0, 2.0}, R * kFrom);
    ASSERT_TRUE(plane);
    EXPECT_LT(std::acos(std::abs(plane->normal().dot(R * Eigen::Vector3d::UnitY()))), 0.01) << turn;
    EXPECT_LT(std::abs(plane->signedDistance(Eigen::Vector3d::Zero())), 0.05) << turn;
    EXPECT_GT(plane->confidence, 0.8) << "straight sides, and nothing in free space";
  }
}

TEST(MiddlePlaneOfBox, DoubtsWhatHasNoStraightSides) {
  RandomStream random(3);
  Points cloud(3, 400);
  for (Eigen::Index i = 0; i < cloud.cols(); ++i)
    cloud.col(i) << static_cast<float>(4.0 * random.uniform()), static_cast<float>(2.0 * random.uniform()),
        static_cast<float>(random.uniform());
  const auto plane = middlePlaneOfBox(cloud, Eigen::Vector3d::UnitZ(), kFrom);
  if (plane) {
    EXPECT_LT(plane->confidence, 0.5);
  }
}

TEST(MiddlePlaneOfBox, SpacingIsThatOfAGrid) {
  Points grid(3, 400);
  for (Eigen::Index i = 0; i < 400; ++i)
    grid.col(i) << 0.5f * static_cast<float>(i % 20), 0.5f * static_cast<float>(i / 20), 0.0f;
  EXPECT_NEAR(spacingOf(grid), 0.5, 0.2 * 0.5) << "8 neighbors give it to 18 %";
}

}  // namespace
}  // namespace pcl_symmetry
