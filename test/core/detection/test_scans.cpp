/// Planes of what a scanner saw from one side, and of what stands on a ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/detection/plane_decision.h"
#include "core/detection/standing_object.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/visibility.h"
#include "shapes/scans.h"

namespace pcl_symmetry {
namespace {

using namespace test;

TEST(Scans, ACameraThatResolvesTooLittleDecidesNothing) {
  const Scan view = scan(blockBox(), {2.5, -3.0, 2.0});
  const Points cloud = view.cloud();
  const double depth = (centerOfMass(cloud) - view.viewpoint).norm();
  const auto kindAt = [&](double resolution) {  // in diameters
    const double error = resolution * diagonal(cloud) / (3.07 * depth * depth);
    const Visibility seen = view.visibility().withDepthErrors(error);
    return detectPlanes({cloud, &seen}).planes.front().kind;
  };
  EXPECT_EQ(kindAt(0.04), PlaneKind::Symmetry);
  EXPECT_EQ(kindAt(0.1), PlaneKind::Possible);
}

bool hasSymmetry(const Detection& detection) {
  return detection.hasFamily() ||
         std::any_of(detection.planes.begin(), detection.planes.end(),
                     [](const SymmetryPlane& plane) { return plane.kind == PlaneKind::Symmetry; });
}

/// Two boxes on a table, of which the picture shows 60 columns.
Scan tableInStrip() {
  const BlockObject table{{{{0.0, 0.0, -0.05}, {3.0, 3.0, 0.05}},
                           {{-0.5, 0.0, 0.2}, {0.25, 0.15, 0.2}},
                           {{0.5, 0.0, 0.2}, {0.25, 0.15, 0.2}}},
                          {}};
  Scan view = scan(table, {0.0, -5.0, 4.0}, 0.0);
  for (int v = 0; v < view.height; ++v)
    for (int u = 0; u < view.width; ++u)
      if (std::abs(u - 0.5 * (view.width - 1)) > 30.0)
        view.pixels.col(v * view.width + u).setConstant(std::numeric_limits<float>::quiet_NaN());
  return view;
}

/// \param width of the middle of the picture, which is left.
Visibility seenWith(const Scan& view, int width) {
  const Visibility seen = view.visibility();
  const int first = (view.width - width) / 2;
  std::vector<float> depths;
  for (int v = 0; v < view.height; ++v)
    for (int u = 0; u < width; ++u) depths.push_back(seen.depth(first + u, v));
  Eigen::Matrix3d camera;
  camera << view.focal, 0.0, 0.5 * (width - 1), 0.0, view.focal, 0.5 * (view.height - 1), 0.0, 0.0, 1.0;
  const Visibility::Projection projection = camera * view.T_camera_object.matrix().topRows<3>();
  return Visibility(projection, width, view.height, std::move(depths)).withDepthErrors(1e-6);
}

TEST(OpenSurfaces, TableThatThePictureCutsOffIsPossibleAtMost) {
  const Scan view = tableInStrip();
  const Points cloud = view.cloud();
  const Visibility whole = seenWith(view, view.width), cut = seenWith(view, 60);
  EXPECT_TRUE(hasSymmetry(detectPlanes({cloud, &whole}))) << "a long table";
  EXPECT_FALSE(hasSymmetry(detectPlanes({cloud, &cut})));
}

TEST(OpenSurfaces, OneFlatSideAloneIsPossibleAtMost) {
  const Scan view = scan({{{{0.0, 0.0, 0.0}, {0.6, 0.4, 0.2}}}, {}}, {0.0, 0.0, 5.0});
  const Points cloud = noisy({view.cloud().cast<double>(), {}}, 0.002, 1).cloud();
  const Visibility seen = view.visibility(), standing = seen.withSupport({0.0, 0.0, 1.0, 0.2}, 0.01);
  const Detection alone = detectPlanes({cloud, &seen});
  EXPECT_FALSE(alone.planes.empty());
  EXPECT_FALSE(hasSymmetry(alone));
  EXPECT_TRUE(hasSymmetry(detectPlanes({cloud, &standing}))) << "a flat box on a table";
}

/// Points in a cube of unit side that stands at a height.
Points cubeAt(double height) {
  RandomStream random(1);
  Points points = Points::NullaryExpr(3, 500, [&] { return static_cast<float>(random.uniform()); });
  points.row(2).array() += static_cast<float>(height);
  return points;
}

Visibility seenFromAbove(const Points& points) {
  return *Visibility::ofScene(points, {0.5, 0.5, 6.0});
}

const Eigen::Vector4d kTable(0.0, 0.0, 1.0, 0.0), kWall(1.0, 0.0, 0.0, 0.0);

/// A plane whose normal is this far from the vertical, degrees, turned about it.
ReflectionPlane planeAt(double angle, double turn) {
  const double a = angle * kDegree, t = turn * kDegree;
  return {{std::sin(a) * std::cos(t), std::sin(a) * std::sin(t), std::cos(a)}, 0.5};
}

TEST(StandingObject, PlanesSlantWhereTheyAreNeitherUprightNorLevel) {
  const Points points = cubeAt(0.0);
  const auto normals = supportNormals(points, seenFromAbove(points).withSupport(kTable, 0.0));
  ASSERT_EQ(normals.size(), 1u);
  for (const double angle : {0.0, 4.0, 86.0, 90.0, 94.0, 176.0})
    for (const double turn : {0.0, 50.0}) EXPECT_FALSE(isSlanted(planeAt(angle, turn), normals)) << angle;
  for (const double angle : {6.0, 45.0, 84.0, 96.0, 150.0})
    for (const double turn : {0.0, 50.0}) EXPECT_TRUE(isSlanted(planeAt(angle, turn), normals)) << angle;
  EXPECT_FALSE(isSlanted(planeAt(45.0, 0.0), {})) << "nothing carries it";
}

TEST(StandingObject, ItStandsOnTheNearestSupport) {
  // The wall is one side away; then the cube touches both.
  Points points = cubeAt(0.0);
  points.row(0).array() += 1.0f;
  const Visibility seen = seenFromAbove(points).withSupport(kWall, 0.0).withSupport(kTable, 0.0);
  ASSERT_EQ(supportNormals(points, seen).size(), 1u);
  EXPECT_EQ(supportNormals(points, seen).front(), Eigen::Vector3d::UnitZ());
  const Points at_the_wall = cubeAt(0.0);
  const auto both =
      supportNormals(at_the_wall, seenFromAbove(at_the_wall).withSupport(kWall, 0.0).withSupport(kTable, 0.0));
  ASSERT_EQ(both.size(), 2u);
  EXPECT_FALSE(isSlanted(planeAt(90.0, 45.0), both)) << "upright, and askew to the wall";
  EXPECT_TRUE(isSlanted(planeAt(45.0, 45.0), both));
  EXPECT_TRUE(supportNormals(points, seenFromAbove(points)).empty());
}

/// Rows of points on two sides of a box of 4 x 2 x 1 on the ground, as rings of a LiDAR at kBeside show it.
Points ringsOnBox() {
  Points points(3, 6 * 61);
  for (int i = 0; i < points.cols(); ++i) {
    const int k = i % 61;
    const float z = 0.1f + 0.16f * static_cast<float>(i / 61);
    const float along = 0.1f * static_cast<float>(k <= 40 ? k : k - 40);
    points.col(i) << (k <= 40 ? along - 2.0f : -2.0f), (k <= 40 ? -1.0f : along - 1.0f), z;
  }
  return points;
}

const Eigen::Vector3d kBeside(-6.0, -9.0, 1.5);

TEST(MiddlePlaneOfBox, IsAlongTheLongerSideAndTurnsWithThePoints) {
  for (const double turn : {0.0, 0.4, 1.3, 2.9}) {
    const Eigen::Isometry3d R(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
    const auto plane = middlePlaneOfBox(moved(ringsOnBox(), R), {0.0, 0.0, 2.0}, R * kBeside);
    ASSERT_TRUE(plane);
    EXPECT_LT(std::acos(std::abs(plane->normal().dot(R * Eigen::Vector3d::UnitY()))), 0.01) << turn;
    EXPECT_LT(std::abs(plane->signedDistance(Eigen::Vector3d::Zero())), 0.05) << turn;
    EXPECT_NEAR(plane->confidence, 0.94, 0.06) << "straight sides, and nothing in free space: " << turn;
  }
}

TEST(MiddlePlaneOfBox, DoubtsWhatHasNoStraightSides) {
  const Points cloud = Eigen::Vector3f(4.0f, 2.0f, 1.0f).asDiagonal() * cubeAt(0.0);
  const auto plane = middlePlaneOfBox(cloud, Eigen::Vector3d::UnitZ(), kBeside);
  ASSERT_TRUE(plane);
  EXPECT_LT(plane->confidence, 0.5);
}

TEST(DecideByUprightBox, ReplacesItsPlaneAndKeepsToTheNumberOfPlanes) {
  const Points points = ringsOnBox();
  const Visibility seen = Visibility::ofScene(points, kBeside)->withSupport(kTable, 0.0);
  const auto decided = [&](const Visibility& visibility, double resolution, int max_planes) {
    Detection found;
    found.tolerance = 0.1;
    found.diameter = 4.5;
    found.resolution = resolution;
    for (const Eigen::Vector3d& normal : {Eigen::Vector3d(0.0, 1.0, 0.01), Eigen::Vector3d(1.0, 0.0, 0.0)}) {
      found.planes.emplace_back(ReflectionPlane(normal, 0.0));
      found.planes.back().kind = PlaneKind::Possible;
      found.planes.back().confidence = 0.3;
    }
    DetectionOptions options;
    options.max_planes = max_planes;
    decideByUprightBox(points, visibility, options, found);
    return found.planes;
  };
  const std::vector<SymmetryPlane> planes = decided(seen, 0.0, 64);
  ASSERT_EQ(planes.size(), 2u) << "the same plane as possible one is gone";
  EXPECT_EQ(planes[0].kind, PlaneKind::Symmetry);
  EXPECT_GT(std::abs(planes[0].normal().y()), 0.99);
  EXPECT_EQ(planes[1].kind, PlaneKind::Possible);
  EXPECT_EQ(decided(seen, 0.0, 1).size(), 1u);
  EXPECT_EQ(decided(seen, 1.0, 1).front().kind, PlaneKind::Possible) << "the sensor resolves too little";
  EXPECT_EQ(decided(seenFromAbove(points), 0.0, 64).front().confidence, 0.3) << "nothing carries it";
}

TEST(DecideByUprightBox, OfWhatThePictureCutsOffIsPossible) {
  // Rows of points on the long side of a vehicle whose cabin stands back; a picture from x = -6, y = -3 ends there.
  std::vector<Eigen::Vector3f> kept;
  for (int i = 0; i < 12 * 81; ++i) {
    const Eigen::Vector3f x(0.05f * static_cast<float>(i % 81) - 2.0f, i / 81 < 6 ? -1.0f : -0.4f,
                            0.1f + 0.1f * static_cast<float>(i / 81));
    if (std::atan2(x.x() + 6.0f, x.y() + 3.0f) > 1.13f) kept.push_back(x);
  }
  const Eigen::Map<const Points> points(kept[0].data(), 3, static_cast<Eigen::Index>(kept.size()));
  const auto kind = [&](const Eigen::Vector3d& viewpoint) {
    const Visibility seen = Visibility::ofScene(points, viewpoint)->withSupport(kTable, 0.0);
    Detection found;
    found.tolerance = 0.02;
    found.diameter = 4.5;
    decideByUprightBox(points, seen, {}, found);
    return found.planes.empty() ? PlaneKind::Local : found.planes.front().kind;
  };
  EXPECT_EQ(kind({-6.0, -3.0, 1.5}), PlaneKind::Possible);
  EXPECT_EQ(kind({-6.0, -2.8, 1.5}), PlaneKind::Symmetry) << "not in one line from there";
}

TEST(Scans, FewSamplesOfRefinementAreEnoughForNumbers) {
  const Scan view = scan(blockL(), {2.5, -3.0, 2.0});
  const Points cloud = view.cloud();
  const Visibility seen = view.visibility();
  DetectionOptions options;
  options.approximate = true;
  options.expert.num_refine_samples = 10;
  for (const SymmetryPlane& plane : detectPlanes({cloud, &seen}, options).planes)
    EXPECT_TRUE(std::isfinite(plane.confidence) && std::isfinite(plane.support));
}

}  // namespace
}  // namespace pcl_symmetry
