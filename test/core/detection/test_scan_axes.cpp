/// Axes of turns from one side: what the scanner saw confirms them, and a visible handle contradicts.
#include "core/detection/scan_axes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/constants.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/one_side.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
