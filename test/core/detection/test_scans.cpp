/// Planes and turns of what a scanner saw from one side, and of what stands on a ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/detection/plane_decision.h"
#include "core/detection/scan_axes.h"
#include "core/detection/upright_box.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/visibility.h"
#include "shapes/found_planes.h"
#include "shapes/scans.h"
#include "shapes/threads.h"
#include "shapes/turning_shapes.h"

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
    std::vector<SymmetryPlane> planes = {planeAt(40.0, 0.0, 0.95), planeAt(90.0, 0.0, 0.7), planeAt(30.0, 0.0, 0.55)};
    PlaneDecision(cloud, *fit, options).doubtSlanted(planes);
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

/// A shape as a scanner sees it from one side.
struct SeenFromOneSide {
  Points points;
  std::optional<Visibility> seen;
};

/// The points of a shape that no other hides, as seen from a place.
SeenFromOneSide seenFrom(const TurningShape& shape, const Eigen::Vector3d& viewpoint, std::uint64_t seed = 1) {
  const Points all = shape.sampled(14000, seed).cloud();
  const std::optional<Visibility> whole = Visibility::fromPoints(all, viewpoint);
  EXPECT_TRUE(whole.has_value());
  // Radii of the shapes
  const Points kept =
      pointsWhere(all, [&](const Eigen::Vector3f& x) { return whole->depthBehind(x.cast<double>()) < 0.08; });
  return {kept, Visibility::fromPoints(kept, viewpoint)};
}

SymmetryTurn turnOf(int fold, double support, double off, double far, double halfway) {
  SymmetryTurn turn{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  turn.fold = fold;
  turn.support = support;
  turn.off = off;
  turn.far = far;
  turn.halfway = halfway;
  return turn;
}

/// What confirms a half turn.
RotationSigns clearSigns() {
  RotationSigns signs;
  signs.grown = 1.0;
  signs.hold = 0.1;
  signs.planes_off = 0.0;
  return signs;
}

double confidenceOf(int fold, double support, double off, double far, double halfway,
                    const RotationSigns& signs = clearSigns()) {
  return rotationConfidence(turnOf(fold, support, off, far, halfway), signs);
}

TEST(TurnConfidence, FallsWithWhatLandsInEmptySpaceAndGrowsWithWhatLandsOnTheSurface) {
  for (const int fold : {0, 2, 6}) {
    const double clear = confidenceOf(fold, 0.95, 0.0, 0.0, 0.4);
    EXPECT_GT(clear, 0.5) << fold;
    EXPECT_LT(clear, 1.0) << fold;
    EXPECT_LT(confidenceOf(fold, 0.95, 0.1, 0.02, 0.5), 0.3) << fold << ": a tenth contradicts";
    EXPECT_LT(confidenceOf(fold, 0.2, 0.0, 0.0, 0.4), clear) << fold << ": hardly anything confirms it";
  }
}

TEST(TurnConfidence, OfAHalfTurnFallsWithEachSignAgainstIt) {
  const double clear = confidenceOf(2, 0.9, 0.0, 0.0, 0.4);
  // Each sign alone, from clear to clearly against.
  const std::array<std::pair<double RotationSigns::*, double>, 4> against{{{&RotationSigns::grown, 1.5},
                                                                           {&RotationSigns::hold, 1e-9},
                                                                           {&RotationSigns::planes_off, 0.3},
                                                                           {&RotationSigns::beside, 1.0}}};
  for (std::size_t k = 0; k < against.size(); ++k) {
    const auto [sign, worst] = against[k];
    const double best = clearSigns().*sign;
    double last = clear;
    for (int step = 1; step <= 5; ++step) {
      RotationSigns signs = clearSigns();
      signs.*sign = best + (worst - best) * step / 5;
      const double confidence = confidenceOf(2, 0.9, 0.0, 0.0, 0.4, signs);
      EXPECT_LE(confidence, last) << "sign " << k << ", step " << step;
      last = confidence;
    }
    EXPECT_LT(last, 0.95 * clear) << "sign " << k;
  }
}

TurningShape box() {
  return boxShape("box", {1.0, 0.7, 0.45}, RotationGroupKind::Dihedral, 2);
}

/// A scan of a shape, and what it says of half turns.
struct Scanned {
  Scanned(const TurningShape& shape, const Eigen::Vector3d& viewpoint)
      : scan(seenFrom(shape, viewpoint)),
        edt(scan.points),
        cloud(scan.points, edt, nullptr, &scan.seen.value(), 1),
        evidence(cloud, tolerance * cloud.extent, 0) {}

  /// A half turn about a line of the shape's frame, with the shares that were seen.
  SymmetryTurn turn(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const {
    SymmetryTurn turn{point, direction.normalized()};
    turn.fold = 2;
    const RotationShares shares = evidence.exactly(Eigen::Affine3d(motionAbout(lineOf(turn), kPi)));
    turn.support = shares.on;
    turn.off = shares.off;
    turn.far = shares.far;
    turn.halfway = 1.0;
    return turn;
  }

  Line3d lineOf(const SymmetryTurn& turn) const { return {(turn.point - cloud.center) / cloud.scale, turn.direction}; }

  static constexpr double tolerance = 0.01;
  SeenFromOneSide scan;
  GaussianEdt edt;
  NormalizedCloud cloud;
  RotationEvidence evidence;
};

const Eigen::Vector3d kCorner(2.0, 3.0, 5.0);

TEST(RotationSigns, AHalfTurnOfABoxHasPlanesAndStaysInItsPlace) {
  const Scanned scanned(box(), kCorner);
  const SymmetryTurn right = scanned.turn(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  const SymmetryTurn wrong = scanned.turn({0.5, 0.0, 0.0}, {0.3, 0.0, 1.0});
  const std::vector<RotationSigns> signs = rotationSigns(scanned.evidence, {right, wrong});
  ASSERT_EQ(signs.size(), 2u);
  EXPECT_LT(signs[0].planes_off, 0.02);
  EXPECT_GT(signs[1].planes_off, 0.1);
  // The box seen from a corner shows its longest diagonal.
  EXPECT_LT(signs[0].grown, 1.05);
  EXPECT_GT(signs[1].grown, 1.05);
  EXPECT_EQ(signs[0].beside, 0.0);
  EXPECT_EQ(signs[1].beside, 1.0);
  // A turn that the other signs leave too little confidence is not asked for planes.
  const std::vector<RotationSigns> few = rotationSigns(scanned.evidence, {right, wrong}, 0.2);
  EXPECT_EQ(few[0].planes_off, signs[0].planes_off);
  EXPECT_EQ(few[1].planes_off, 0.0);
  EXPECT_LT(rotationConfidence(wrong, few[1]), 0.2);
}

TEST(RotationSigns, AFlatSideHoldsNoLineAndABoxDoes) {
  const Scanned flat(sheetShape(1.0, 0.7), {0.3, 0.5, 5.0});
  const SymmetryTurn over = flat.turn(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX());
  EXPECT_GT(over.support, 0.95) << "the shares alone take the lower side for the upper one";
  const auto hold = [](const Scanned& scanned, const Eigen::Vector3d& direction) {
    return rotationSigns(scanned.evidence, {scanned.turn(Eigen::Vector3d::Zero(), direction)})[0].hold;
  };
  EXPECT_LT(hold(flat, Eigen::Vector3d::UnitX()), 1e-3) << "it slides both ways along itself";
  EXPECT_GT(hold(Scanned(box(), kCorner), Eigen::Vector3d::UnitZ()), 1e-2);
}

TEST(RotationEvidence, ALineBesideTheAxisComesBackToIt) {
  for (const Eigen::Vector3d& viewpoint : {kCorner, Eigen::Vector3d(5.0, 1.0, 3.0), Eigen::Vector3d(1.0, -2.0, 5.0)}) {
    const Scanned scanned(box(), viewpoint);
    const SymmetryTurn beside = scanned.turn({0.03, -0.03, 0.0}, {0.03, 0.02, 1.0});
    const Line3d line = scanned.evidence.closelyRefined(scanned.lineOf(beside), {kPi});
    const Eigen::Vector3d center = -scanned.cloud.center / scanned.cloud.scale;
    // Within the tolerance of the surface, by which a line that is half as far off moves it.
    EXPECT_LT(line.distance(center), 0.5 * Scanned::tolerance * scanned.cloud.extent);
    EXPECT_GT(std::abs(line.direction().z()), std::cos(0.5 * kDegree));
  }
}

Detection detected(const TurningShape& shape, const Eigen::Vector3d& viewpoint) {
  const SeenFromOneSide scan = seenFrom(shape, viewpoint);
  return detectPlanes({scan.points, &*scan.seen});
}

TurningShape cup(bool with_handle) {
  TurningShape shape = turningShape("cup", RotationGroupKind::Revolution);
  shape.addLathe({{0.0, -1.0}, {0.6, -1.0}, {0.8, 0.2}, {0.75, 1.0}, {0.0, 1.0}}, 96);
  if (with_handle)
    for (const double z : {-0.35, 0.0, 0.35}) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() << (z == 0.0 ? 1.3 : 1.0), 0.0, z;
      shape.addBox(z == 0.0 ? Eigen::Vector3d(0.1, 0.1, 0.45) : Eigen::Vector3d(0.35, 0.1, 0.1), pose);
    }
  return shape;
}

TEST(ScanAxes, AHexagonalPrismHasOrderSix) {
  const Detection found = detected(prismShape(6, 0.5), {3.0, 4.0, 5.0});
  ASSERT_FALSE(found.turns.empty());
  const SymmetryTurn& turn = found.turns.front();
  EXPECT_EQ(turn.fold, 6);
  EXPECT_GT(turn.confidence, 0.5);
  EXPECT_GT(std::abs(turn.direction.z()), std::cos(1.0 * kDegree));
  EXPECT_LT(turn.point.head<2>().norm(), 0.03);
  EXPECT_GT(turn.halfway, turn.off);
  EXPECT_TRUE(found.axes.empty()) << "six sides are not round";
}

TEST(ScanAxes, ACupHasAnAxisUnlessAHandleIsInSight) {
  const Detection plain = detected(cup(false), {1.0, 5.0, 1.5});
  ASSERT_EQ(plain.axes.size(), 1u);
  EXPECT_GT(std::abs(plain.axes[0].direction.z()), std::cos(1.0 * kDegree));
  EXPECT_LT(plain.axes[0].point.head<2>().norm(), 0.03);
  // From the side the handle is seen against the background.
  EXPECT_TRUE(detected(cup(true), {1.0, 5.0, 1.5}).axes.empty());
}

TEST(ScanAxes, AreFoundWithoutPlanesToo) {
  const SeenFromOneSide scan = seenFrom(prismShape(6, 0.5), {3.0, 4.0, 5.0});
  const GaussianEdt edt(scan.points);
  const std::vector<SymmetryTurn> turns = rotationsOfScan(scan.points, edt, *scan.seen, {}, {});
  ASSERT_FALSE(turns.empty());
  EXPECT_EQ(turns.front().fold, 6);
  EXPECT_GT(turns.front().confidence, 0.5);
  EXPECT_GT(std::abs(turns.front().direction.z()), std::cos(1.0 * kDegree));
  const Points few = scan.points.leftCols(5);
  EXPECT_TRUE(rotationsOfScan(few, GaussianEdt(few), *scan.seen, {}, {}).empty()) << "no answer";
}

TEST(ScanAxes, ThreadsDoNotMatterAndTurnsCanBeLeftOut) {
  const SeenFromOneSide scan = seenFrom(prismShape(5, 0.4), {2.0, 3.0, 5.0});
  DetectionOptions options;
  compareThreads([&](int num_threads) {
    options.num_threads = num_threads;
    const Detection found = detectPlanes({scan.points, &*scan.seen}, options);
    return valuesOf(found.turns, &SymmetryTurn::point, &SymmetryTurn::confidence);
  });
  options.turns = false;
  EXPECT_TRUE(detectPlanes({scan.points, &*scan.seen}, options).turns.empty());
  EXPECT_TRUE(detectPlanes(scan.points, options).turns.empty()) << "whole objects have objectSymmetries()";
}

}  // namespace
}  // namespace pcl_symmetry
