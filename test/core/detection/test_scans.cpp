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
#include "shapes/found_planes.h"
#include "shapes/scans.h"
#include "shapes/threads.h"

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

TEST(Scans, SameBytesForAnyNumberOfThreads) {
  const Scan view = scan(blockL(), {2.5, -3.0, 2.0});
  const Points cloud = view.cloud();
  const Visibility visibility = view.visibility();
  const auto detect = [&](int num_threads) {
    DetectionOptions options;
    options.num_threads = num_threads;
    return detectPlanes({cloud, &visibility}, options);
  };
  compareThreads(detect, [](const Detection& many, const Detection& one) {
    EXPECT_EQ(many.map.values, one.map.values);
    expectSamePlanes(many.planes, one.planes);
  });
}

bool hasSymmetry(const Detection& detection) {
  return !detection.axes.empty() || !detection.centers.empty() ||
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
    const auto fit = makePlaneFit(cloud, options);
    const PlaneMeasure measure(cloud, *fit, options);
    std::vector<SymmetryPlane> planes = {planeAt(40.0, 0.0, 0.95), planeAt(90.0, 0.0, 0.7), planeAt(30.0, 0.0, 0.55)};
    PlaneDecision(cloud, measure, options).doubtSlantedPlanes(planes);
    return reordered(planes, options);
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

}  // namespace
}  // namespace pcl_symmetry
