/// Iterated closest points with the symmetric objective.
#include "core/registration/refinement/symmetric_icp.h"

#include <gtest/gtest.h>

#include "shapes/posed_surfaces.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(SymmetricICP, FindsThePoseFromNearIt) {
  const Shape shape = asymmetricBlob(4000, 1);
  const Eigen::Isometry3d T_model_scan = randomPose(4, 0.5);
  const PosedSurface model = surface(shape.cloud());
  const PosedSurface scan = surface(moved(asymmetricBlob(4000, 2), T_model_scan.inverse()).cloud());
  Eigen::Isometry3d start = T_model_scan;
  start.prerotate(Eigen::AngleAxisd(0.15, Eigen::Vector3d(3, 1, -2).normalized()));
  start.pretranslate(Eigen::Vector3d(0.03, -0.05, 0.04));
  SymmetricICPOptions options;
  options.reach = 0.3;
  const Eigen::Isometry3d error = refinedBySymmetricICP(scan, model, start, options) * T_model_scan.inverse();
  // derived: points of 4 pi of area are 0.06 apart, 1000 of them tell a plane apart to 0.06 / sqrt(1000) = 0.002; the
  // blob is bent, so that a tenth of the spacing is left.
  EXPECT_LT(angleOf(error), 0.006);
  EXPECT_LT(error.translation().norm(), 0.006);
  EXPECT_NEAR(error.linear().determinant(), 1.0, 1e-9);
}

TEST(SymmetricICP, SignsOfNormalsDoNotCount) {
  const PosedSurface model = surface(asymmetricBlob(2000, 1).cloud());
  PosedSurface scan = surface(asymmetricBlob(2000, 2).cloud());
  Eigen::Isometry3d start(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  SymmetricICPOptions options;
  options.reach = 0.3;
  const Eigen::Isometry3d pose = refinedBySymmetricICP(scan, model, start, options);
  for (Eigen::Index i = 0; i < scan.normals.cols(); i += 2) scan.normals.col(i) *= -1.0f;
  EXPECT_TRUE(refinedBySymmetricICP(scan, model, start, options).isApprox(pose, 1e-9));
}

TEST(SymmetricICP, APoseWithoutPairsStays) {
  const PosedSurface model = surface(asymmetricBlob(2000, 1).cloud()), scan = model;
  Eigen::Isometry3d far = Eigen::Isometry3d::Identity();
  far.translation().x() = 100.0;
  EXPECT_EQ(refinedBySymmetricICP(scan, model, far, {}).matrix(), far.matrix());
}

TEST(SymmetricICP, APlaneKeepsThePoseFinite) {
  // It fixes three of six directions.
  Points plane(3, 400);
  for (Eigen::Index i = 0; i < 400; ++i)
    plane.col(i) =
        Eigen::Vector3f(0.1f * static_cast<float>(i % 20) - 1.0f, 0.1f * static_cast<float>(i / 20) - 1.0f, 0.0f);
  const PosedSurface model = surface(plane), scan = model;
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.translation().z() = 0.05;
  EXPECT_TRUE(refinedBySymmetricICP(scan, model, start, {}).matrix().allFinite());
}

}  // namespace
