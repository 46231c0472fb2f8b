/// Where the search for a pose starts.
#include "core/registration/pose_starts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shapes/scans.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(UniformRotations, CoverAllRotations) {
  constexpr int kNumRotations = 1000;
  const std::vector<Eigen::Matrix3d> rotations = uniformRotations(kNumRotations);
  ASSERT_EQ(rotations.size(), static_cast<std::size_t>(kNumRotations));
  for (const Eigen::Matrix3d& rotation : rotations) {
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-9);
    EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  }
  for (int i = 0; i < 300; ++i) {
    const Eigen::Matrix3d wanted = randomPose(i).linear();
    double least = kPi;
    for (const Eigen::Matrix3d& rotation : rotations)
      least = std::min(least, Eigen::AngleAxisd(rotation.transpose() * wanted).angle());
    EXPECT_LT(least, 20.0 * kDegree) << "balls of 14 degrees about 1000 rotations would fill the space once";
  }
}

TEST(PoseStarts, OfWholesPutCenterOfMassOnCenterOfMass) {
  const Shape shape = asymmetricBlob(1000, 1);
  const PosedSurface model(shape.cloud(), std::nullopt, 1, 1);
  const PosedSurface scan(moved(shape, randomPose(3)).cloud(), std::nullopt, 1, 1);
  const Eigen::Matrix3d rotation = randomPose(5).linear();
  const Eigen::Isometry3d start = PoseStarts(scan, model).pose(rotation);
  EXPECT_EQ(start.linear(), rotation);
  EXPECT_LT((start * centerOfMass(scan.points) - centerOfMass(model.points)).norm(), 1e-6);
}

/// With the right rotation the outline of a scan stands where the object is, though its center of mass does not.
TEST(PoseStarts, OfScansPutOutlineOnOutline) {
  const BlockObject object = blockBox();
  const PosedSurface model(surfaceOf(object, 4000), std::nullopt, 1, 1);
  for (const Eigen::Vector3d& viewpoint : {Eigen::Vector3d(0.0, -6.0, 0.0), Eigen::Vector3d(4.0, 3.0, -3.0)}) {
    const Scan scanned = test::scan(object, viewpoint);
    const PosedSurface scan(scanned.cloud(), scanned.visibility(), 1, 1);
    const Eigen::Isometry3d start = PoseStarts(scan, model).pose(Eigen::Matrix3d::Identity());
    EXPECT_LT(start.translation().norm(), 0.15) << viewpoint.transpose();
    EXPECT_GT((centerOfMass(model.points) - centerOfMass(scan.points)).norm(), 0.3) << viewpoint.transpose();
  }
}

}  // namespace
