/// What a scan says of turns, the probability that follows from it, and the axes that a visible handle contradicts.
#include "core/detection/turn_confidence.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/constants.h"
#include "core/detection/scan_axes.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/visibility.h"
#include "shapes/turning_shapes.h"

namespace pcl_symmetry {
namespace {

using namespace test;

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
  // radii of the shapes; chosen: above the depth of a slanted pixel, below the thickness of the shapes
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
TurnSigns clearSigns() {
  TurnSigns signs;
  signs.grown = 1.0;
  signs.hold = 0.1;
  signs.planes_off = 0.0;
  return signs;
}

double confidenceOf(int fold, double support, double off, double far, double halfway,
                    const TurnSigns& signs = clearSigns()) {
  return turnConfidence(turnOf(fold, support, off, far, halfway), signs);
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
  const std::array<std::pair<double TurnSigns::*, double>, 4> against{
      {{&TurnSigns::grown, 1.5}, {&TurnSigns::hold, 1e-9}, {&TurnSigns::planes_off, 0.3}, {&TurnSigns::beside, 1.0}}};
  for (std::size_t k = 0; k < against.size(); ++k) {
    const auto [sign, worst] = against[k];
    const double best = clearSigns().*sign;
    double last = clear;
    for (int step = 1; step <= 5; ++step) {
      TurnSigns signs = clearSigns();
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

TurningShape sheet() {
  TurningShape shape = turningShape("sheet", RotationGroupKind::Dihedral, 2);
  shape.addFace({{-1.0, -0.7, 0.0}, {1.0, -0.7, 0.0}, {1.0, 0.7, 0.0}, {-1.0, 0.7, 0.0}});
  return shape;
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
    const TurnShares shares = evidence.exactly(Eigen::Affine3d(turnAbout(lineOf(turn), kPi)));
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
  TurnEvidence evidence;
};

const Eigen::Vector3d kCorner(2.0, 3.0, 5.0);

TEST(TurnSigns, AHalfTurnOfABoxHasPlanesAndStaysInItsPlace) {
  const Scanned scanned(box(), kCorner);
  const SymmetryTurn right = scanned.turn(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  const SymmetryTurn wrong = scanned.turn({0.5, 0.0, 0.0}, {0.3, 0.0, 1.0});
  const std::vector<TurnSigns> signs = turnSigns(scanned.evidence, {right, wrong});
  ASSERT_EQ(signs.size(), 2u);
  EXPECT_LT(signs[0].planes_off, 0.02);
  EXPECT_GT(signs[1].planes_off, 0.1);
  // The box seen from a corner shows its longest diagonal.
  EXPECT_LT(signs[0].grown, 1.05);
  EXPECT_GT(signs[1].grown, 1.05);
  EXPECT_EQ(signs[0].beside, 0.0);
  EXPECT_EQ(signs[1].beside, 1.0);
  // A turn that the other signs leave too little confidence is not asked for planes.
  const std::vector<TurnSigns> few = turnSigns(scanned.evidence, {right, wrong}, 0.2);
  EXPECT_EQ(few[0].planes_off, signs[0].planes_off);
  EXPECT_EQ(few[1].planes_off, 0.0);
  EXPECT_LT(turnConfidence(wrong, few[1]), 0.2);
}

TEST(TurnSigns, AFlatSideHoldsNoLineAndABoxDoes) {
  const Scanned flat(sheet(), {0.3, 0.5, 5.0});
  const SymmetryTurn over = flat.turn(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX());
  EXPECT_GT(over.support, 0.95) << "the shares alone take the lower side for the upper one";
  const auto hold = [](const Scanned& scanned, const Eigen::Vector3d& direction) {
    return turnSigns(scanned.evidence, {scanned.turn(Eigen::Vector3d::Zero(), direction)})[0].hold;
  };
  EXPECT_LT(hold(flat, Eigen::Vector3d::UnitX()), 1e-3) << "it slides both ways along itself";
  EXPECT_GT(hold(Scanned(box(), kCorner), Eigen::Vector3d::UnitZ()), 1e-2);
}

TEST(TurnEvidence, ALineBesideTheAxisComesBackToIt) {
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
  const std::vector<SymmetryTurn> turns = turnsOfScan(scan.points, edt, *scan.seen, {}, {});
  ASSERT_FALSE(turns.empty());
  EXPECT_EQ(turns.front().fold, 6);
  EXPECT_GT(turns.front().confidence, 0.5);
  EXPECT_GT(std::abs(turns.front().direction.z()), std::cos(1.0 * kDegree));
  const Points few = scan.points.leftCols(5);
  EXPECT_TRUE(turnsOfScan(few, GaussianEdt(few), *scan.seen, {}, {}).empty()) << "no answer";
}

TEST(ScanAxes, ThreadsDoNotMatterAndTurnsCanBeLeftOut) {
  const SeenFromOneSide scan = seenFrom(prismShape(5, 0.4), {2.0, 3.0, 5.0});
  DetectionOptions options;
  options.num_threads = 1;
  const Detection one = detectPlanes({scan.points, &*scan.seen}, options);
  options.num_threads = 3;
  const Detection three = detectPlanes({scan.points, &*scan.seen}, options);
  ASSERT_EQ(one.turns.size(), three.turns.size());
  for (std::size_t i = 0; i < one.turns.size(); ++i) {
    EXPECT_EQ(one.turns[i].point, three.turns[i].point);
    EXPECT_EQ(one.turns[i].confidence, three.turns[i].confidence);
  }
  options.turns = false;
  EXPECT_TRUE(detectPlanes({scan.points, &*scan.seen}, options).turns.empty());
  EXPECT_TRUE(detectPlanes(scan.points, options).turns.empty()) << "whole objects have objectSymmetries()";
}

}  // namespace
}  // namespace pcl_symmetry
