/// Axes of rotations of what a scanner saw from one side.
#include "core/rotation/scan_axes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/constants.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/rotation_group.h"
#include "pcl_symmetry/core/symmetric_completion.h"
#include "pcl_symmetry/core/symmetry_frame.h"
#include "pcl_symmetry/core/visibility.h"
#include "shapes/found_planes.h"
#include "shapes/scans.h"
#include "shapes/threads.h"
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
  const Points kept = visiblePoints(shape.sampled(14000, seed).cloud(), viewpoint, 0.08);
  return {kept, Visibility::fromPoints(kept, viewpoint)};
}

/// What confirms a half turn.
HalfTurnEvidence clearEvidence() {
  HalfTurnEvidence signs;
  signs.extent_ratio = 1.0;
  signs.stiffness = 0.1;
  signs.planes_off_share = 0.0;
  return signs;
}

double confidenceOf(int fold, double support, double off, double far, double halfway,
                    const HalfTurnEvidence& signs = clearEvidence()) {
  SymmetryRotation rotation{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  rotation.fold = fold;
  rotation.support = support;
  rotation.off = off;
  rotation.far = far;
  rotation.halfway = halfway;
  return rotationConfidence(rotation, signs);
}

TEST(RotationConfidence, FallsWithWhatLandsInEmptySpaceAndGrowsWithWhatLandsOnTheSurface) {
  for (const int fold : {0, 2, 6}) {
    const double clear = confidenceOf(fold, 0.95, 0.0, 0.0, 0.4);
    EXPECT_GT(clear, 0.5) << fold;
    EXPECT_LT(clear, 1.0) << fold;
    EXPECT_LT(confidenceOf(fold, 0.95, 0.1, 0.02, 0.5), 0.3) << fold << ": a tenth contradicts";
    EXPECT_LT(confidenceOf(fold, 0.2, 0.0, 0.0, 0.4), clear) << fold << ": hardly anything confirms it";
  }
}

TEST(RotationConfidence, OfAHalfTurnFallsWithEachSignAgainstIt) {
  const double clear = confidenceOf(2, 0.9, 0.0, 0.0, 0.4);
  // Each sign alone, from clear to clearly against.
  const std::array<std::pair<double HalfTurnEvidence::*, double>, 4> against{
      {{&HalfTurnEvidence::extent_ratio, 1.5},
       {&HalfTurnEvidence::stiffness, 1e-9},
       {&HalfTurnEvidence::planes_off_share, 0.3},
       {&HalfTurnEvidence::conflicts_with_best, 1.0}}};
  for (const auto& [sign, worst] : against) {
    const double best = clearEvidence().*sign;
    double last = clear;
    for (int step = 1; step <= 5; ++step) {
      HalfTurnEvidence signs = clearEvidence();
      signs.*sign = best + (worst - best) * step / 5;
      const double confidence = confidenceOf(2, 0.9, 0.0, 0.0, 0.4, signs);
      EXPECT_LE(confidence, last) << "toward " << worst << ", step " << step;
      last = confidence;
    }
    EXPECT_LT(last, 0.95 * clear) << "toward " << worst;
  }
}

/// A scan of a shape, and what it says of half turns.
struct Scanned {
  Scanned(const TurningShape& shape, const Eigen::Vector3d& viewpoint)
      : scan(seenFrom(shape, viewpoint)),
        edt(scan.points),
        cloud(scan.points, edt, nullptr, &scan.seen.value(), 1),
        evidence(cloud, tolerance * cloud.diameter, 0) {}

  /// A half turn about a line of the shape's frame, with the shares that were seen.
  SymmetryRotation rotation(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const {
    SymmetryRotation rotation{point, direction.normalized()};
    rotation.fold = 2;
    const RotationShares shares = evidence.measure(Eigen::Affine3d(motionAbout(lineOf(rotation), kPi)));
    rotation.support = shares.on;
    rotation.off = shares.off;
    rotation.far = shares.far;
    rotation.halfway = 1.0;
    return rotation;
  }

  Line3d lineOf(const SymmetryRotation& rotation) const {
    return {(rotation.point - cloud.center) / cloud.scale, rotation.direction};
  }

  static constexpr double tolerance = 0.01;
  SeenFromOneSide scan;
  GaussianEdt edt;
  NormalizedCloud cloud;
  RotationEvidence evidence;
};

const Eigen::Vector3d kCorner(2.0, 3.0, 5.0);

TEST(HalfTurnEvidence, AHalfTurnOfABoxHasPlanesAndStaysInItsPlace) {
  const Scanned scanned(boxShape(), kCorner);
  const SymmetryRotation right = scanned.rotation(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  const SymmetryRotation wrong = scanned.rotation({0.5, 0.0, 0.0}, {0.3, 0.0, 1.0});
  const std::vector<HalfTurnEvidence> signs = halfTurnEvidence(scanned.evidence, {right, wrong});
  ASSERT_EQ(signs.size(), 2u);
  EXPECT_LT(signs[0].planes_off_share, 0.02);
  EXPECT_GT(signs[1].planes_off_share, 0.1);
  // The box seen from a corner shows its longest diagonal.
  EXPECT_LT(signs[0].extent_ratio, 1.05);
  EXPECT_GT(signs[1].extent_ratio, 1.05);
  EXPECT_EQ(signs[0].conflicts_with_best, 0.0);
  EXPECT_EQ(signs[1].conflicts_with_best, 1.0);
  // A rotation that the other signs leave too little confidence is not asked for planes.
  const std::vector<HalfTurnEvidence> few = halfTurnEvidence(scanned.evidence, {right, wrong}, 0.2);
  EXPECT_EQ(few[0].planes_off_share, signs[0].planes_off_share);
  EXPECT_EQ(few[1].planes_off_share, 0.0);
  EXPECT_LT(rotationConfidence(wrong, few[1]), 0.2);
}

TEST(HalfTurnEvidence, AFlatSideHoldsNoLineAndABoxDoes) {
  const Scanned flat(sheetShape(1.0, 0.7), {0.3, 0.5, 5.0});
  const SymmetryRotation over = flat.rotation(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX());
  EXPECT_GT(over.support, 0.95) << "the shares alone take the lower side for the upper one";
  const auto stiffness = [](const Scanned& scanned, const Eigen::Vector3d& direction) {
    return halfTurnEvidence(scanned.evidence, {scanned.rotation(Eigen::Vector3d::Zero(), direction)})[0].stiffness;
  };
  EXPECT_LT(stiffness(flat, Eigen::Vector3d::UnitX()), 1e-3) << "it slides both ways along itself";
  EXPECT_GT(stiffness(Scanned(boxShape(), kCorner), Eigen::Vector3d::UnitZ()), 1e-2);
}

TEST(MarginOf, IsTheLeastMarginToALimit) {
  SymmetryRotation rotation;
  rotation.support = 1.0;
  EXPECT_NEAR(marginOf(rotation), 1.0 / kScanAxes.round_on - 1.0, 1e-12) << "nothing is off";
  rotation.off = 2.0 * kScanAxes.max_round_off;
  EXPECT_NEAR(marginOf(rotation), -1.0, 1e-12);
  rotation.fold = 3;
  rotation.off = rotation.halfway = 0.0;
  EXPECT_NEAR(marginOf(rotation), -1.0, 1e-12) << "rotations halfway between are as good";
}

TEST(WithRoundAxes, AddsWhatOnlyRotationsShowAndNothingContradicts) {
  const Scanned scanned(boxShape(), kCorner);
  SymmetryRotation round{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  round.support = round.confidence = 0.9;
  const auto numAxes = [&](const SymmetryRotation& rotation) {
    return withRoundAxes(scanned.evidence, {}, {rotation}, {}).size();
  };
  EXPECT_EQ(numAxes(round), 1u);
  SymmetryRotation other = round;
  other.fold = 4;
  EXPECT_EQ(numAxes(other), 0u);
  other = round;
  other.confidence = 0.4;
  EXPECT_EQ(numAxes(other), 0u);
  other = round;
  other.far = 0.5;
  EXPECT_EQ(numAxes(other), 0u) << "a handle was seen";
  const SymmetryAxis across{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()};
  EXPECT_TRUE(withRoundAxes(scanned.evidence, {across}, {}, {}).empty()) << "it throws the box into empty space";
}

TEST(RotationEvidence, ALineBesideTheAxisComesBackToIt) {
  for (const Eigen::Vector3d& viewpoint : {kCorner, Eigen::Vector3d(5.0, 1.0, 3.0), Eigen::Vector3d(1.0, -2.0, 5.0)}) {
    const Scanned scanned(boxShape(), viewpoint);
    const SymmetryRotation beside = scanned.rotation({0.03, -0.03, 0.0}, {0.03, 0.02, 1.0});
    const Line3d line = scanned.evidence.refineLineClosely(scanned.lineOf(beside), {kPi});
    const Eigen::Vector3d center = -scanned.cloud.center / scanned.cloud.scale;
    // Within the tolerance of the surface, by which a line that is half as far off moves it.
    EXPECT_LT(line.distance(center), 0.5 * Scanned::tolerance * scanned.cloud.diameter);
    EXPECT_GT(std::abs(line.direction().z()), std::cos(0.5 * kDegree));
  }
}

Detection detected(const TurningShape& shape, const Eigen::Vector3d& viewpoint) {
  const SeenFromOneSide scan = seenFrom(shape, viewpoint);
  return detectPlanes({scan.points, &*scan.seen});
}

TEST(ScanAxes, AHexagonalPrismHasOrderSixAlsoWithoutPlanes) {
  const SeenFromOneSide scan = seenFrom(prismShape(6, 0.5), {3.0, 4.0, 5.0});
  const Detection found = detectPlanes({scan.points, &*scan.seen});
  EXPECT_TRUE(found.axes.empty()) << "six sides are not round";
  const GaussianEdt edt(scan.points);
  for (const auto& rotations : {found.rotations, rotationsOfScan(scan.points, edt, *scan.seen, {}, {}).rotations}) {
    ASSERT_FALSE(rotations.empty());
    const SymmetryRotation& rotation = rotations.front();
    EXPECT_EQ(rotation.fold, 6);
    EXPECT_GT(rotation.confidence, 0.5);
    EXPECT_GT(std::abs(rotation.direction.z()), std::cos(1.0 * kDegree));
    EXPECT_LT(rotation.point.head<2>().norm(), 0.03);
    EXPECT_GT(rotation.halfway, rotation.off);
  }
  const Points few = scan.points.leftCols(5);
  EXPECT_TRUE(rotationsOfScan(few, GaussianEdt(few), *scan.seen, {}, {}).rotations.empty()) << "no answer";
}

TEST(ScanAxes, ACupHasAnAxisUnlessAHandleIsInSight) {
  const Detection plain = detected(cupShape(false), {1.0, 5.0, 1.5});
  ASSERT_EQ(plain.axes.size(), 1u);
  EXPECT_GT(std::abs(plain.axes[0].direction.z()), std::cos(1.0 * kDegree));
  EXPECT_LT(plain.axes[0].point.head<2>().norm(), 0.03);
  // From the side the handle is seen against the background.
  EXPECT_TRUE(detected(cupShape(true), {1.0, 5.0, 1.5}).axes.empty());
}

TEST(ScanAxes, SymmetriesOfACupWithAHandleMapTheHandleOntoItself) {
  int num_true = 0;
  for (int degrees = 0; degrees <= 180; degrees += 30) {
    const double azimuth = degrees * kDegree;
    const Detection found = detected(cupShape(true), {5.0 * std::cos(azimuth), 5.0 * std::sin(azimuth), 2.0});
    for (const SymmetryPlane& plane : found.planes) {
      if (plane.kind != PlaneKind::Symmetry) continue;
      EXPECT_GT(std::abs(plane.normal().y()), std::cos(5.0 * kDegree)) << degrees;
      ++num_true;
    }
  }
  EXPECT_GE(num_true, 2);
}

TEST(ScanAxes, ABallHasACenterAndADomeOneAxis) {
  const Eigen::Vector3d viewpoint(3.0, 4.0, 5.0);
  const SeenFromOneSide ball = seenFrom(ballShape(), viewpoint);
  const Detection found = detectPlanes({ball.points, &*ball.seen});
  ASSERT_EQ(found.centers.size(), 1u);
  EXPECT_LT(found.centers[0].point.norm(), 0.01);
  EXPECT_TRUE(found.axes.empty() && found.planes.empty());
  const std::optional<ReflectionPlane> across = planeAcrossView(found, viewpoint);
  ASSERT_TRUE(across);
  EXPECT_GT(std::abs(across->normal().dot(viewpoint.normalized())), std::cos(1.0 * kDegree)) << "it hides its far half";
  const SymmetryFrame frame = symmetryFrame(ball.points, {}, &*ball.seen);
  EXPECT_EQ(frame.revolution_axis, 3);
  EXPECT_LT(frame.center.norm(), 0.01);

  TurningShape dome = turningShape("dome", RotationGroupKind::Revolution);
  std::vector<Eigen::Vector2d> profile{{0.0, 0.3}};
  for (int k = 0; k <= 24; ++k) {
    const double height = 0.3 + 0.7 * k / 24.0;
    profile.emplace_back(std::sqrt(1.0 - height * height), height);
  }
  dome.addLathe(profile, 96);
  const Detection of_dome = detected(dome, {1.0, 2.0, 5.0});
  EXPECT_TRUE(of_dome.centers.empty());
  ASSERT_EQ(of_dome.axes.size(), 1u) << "others that miss its rim by little are as round within the tolerance";
  EXPECT_GT(std::abs(of_dome.axes[0].direction.z()), std::cos(10.0 * kDegree));
}

TEST(ScanAxes, ThreadsDoNotMatterAndTurnsCanBeLeftOut) {
  const SeenFromOneSide scan = seenFrom(prismShape(5, 0.4), {2.0, 3.0, 5.0});
  DetectionOptions options;
  compareThreads(
      [&](int num_threads) {
        options.num_threads = num_threads;
        return detectPlanes({scan.points, &*scan.seen}, options);
      },
      [](const Detection& many, const Detection& one) {
        EXPECT_EQ(many.map.values, one.map.values);
        expectSamePlanes(many.planes, one.planes);
        EXPECT_EQ(valuesOf(many.rotations, &SymmetryRotation::point, &SymmetryRotation::confidence),
                  valuesOf(one.rotations, &SymmetryRotation::point, &SymmetryRotation::confidence));
        EXPECT_FALSE(one.planes.empty() || one.rotations.empty());
      });
  options.rotations = false;
  EXPECT_TRUE(detectPlanes({scan.points, &*scan.seen}, options).rotations.empty());
  EXPECT_TRUE(detectPlanes(scan.points, options).rotations.empty()) << "whole objects have objectSymmetries()";
}

}  // namespace
}  // namespace pcl_symmetry
