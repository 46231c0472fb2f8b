/// What a scan says of half turns besides the shares of its points.
#include "core/detection/turn_confidence.h"

#include <gtest/gtest.h>

#include "core/base/constants.h"
#include "shapes/one_side.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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

}  // namespace
