#include "pcl_symmetry/core/mesh_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/constants.h"
#include "shapes/meshes.h"

namespace pcl_symmetry {
namespace {

MeshSurface bar() {
  const test::TriangleMesh mesh = test::boxOfTriangles(30, 2, 1);
  return {mesh.vertices, mesh.triangles};
}

MeshSurface rectangle() {
  Points corners(3, 4);
  corners << 0, 2, 2, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  return {corners, {{0, 1, 2}, {0, 2, 3}}};
}

/// Float coordinates resolve 1e-7 of the extent.
TEST(MeshSurface, FitsPlanesExactly) {
  const ReflectionPlane across = bar().fitted(ReflectionPlane({1.0, 0.02, -0.01}, 15.2));
  EXPECT_LT(across.angleTo(ReflectionPlane(Eigen::Vector3d::UnitX(), 15.0)), 1e-6);
  EXPECT_NEAR(std::abs(across.offset()), 15.0, 1e-4);
  const ReflectionPlane along = bar().fitted(ReflectionPlane({0.001, 1.0, 0.1}, 1.05));
  EXPECT_LT(along.angleTo(ReflectionPlane(Eigen::Vector3d::UnitY(), 1.0)), 1e-5);
  EXPECT_NEAR(along.signedDistance({15.0, 1.0, 0.5}), 0.0, 1e-5);
}

/// Inside a flat shape every reflection lies on it: its borders decide.
TEST(MeshSurface, FitsPlanesOfFlatShapesByTheirBorders) {
  const ReflectionPlane plane = rectangle().fitted(ReflectionPlane({1.0, -0.03, 0.0}, 0.97));
  EXPECT_LT(plane.angleTo(ReflectionPlane(Eigen::Vector3d::UnitX(), 1.0)), 1e-5);
  EXPECT_NEAR(plane.signedDistance({1.0, 0.5, 0.0}), 0.0, 1e-5);
}

TEST(MeshSurface, FitsRotationsAsAWhole) {
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  MotionsAbout half_turns{{}, {15.1, 0.98, 0.52}};
  for (int k = 0; k < 3; ++k)
    half_turns.linear.push_back(
        Eigen::AngleAxisd(kPi, Eigen::Vector3d(tilt * Eigen::Vector3d::Unit(k))).toRotationMatrix());
  const MeshSurface::Placement placed = bar().fitted(half_turns);
  EXPECT_LT(Eigen::AngleAxisd(Eigen::Matrix3d(placed.rotation * tilt)).angle(), 1e-5);
  EXPECT_TRUE(placed.center.isApprox(Eigen::Vector3d(15.0, 1.0, 0.5), 1e-5));
}

TEST(MeshSurface, MeasuresWhatAMotionMaps) {
  const MeshSurface mesh = rectangle();
  const auto shares = [&](double x) { return mesh.shares({Eigen::Vector3d::UnitX(), x}, 0.01); };
  EXPECT_EQ(shares(1.0).share, 1.0);
  EXPECT_LT(shares(1.0).deviation, 1e-6);
  // A plane that is off by 0.1 maps a strip of 0.2 - 0.01 of 2 beyond the tolerance.
  EXPECT_NEAR(shares(1.1).share, 1.0 - 0.19 / 2.0, 0.01);
}

TEST(MeshSurface, RefusesWhatIsNoSurface) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Points corners(3, 3);
  corners << 0, 1, 0, 0, 0, nan, 0, 0, 0;
  EXPECT_THROW(MeshSurface(corners, {{0, 1, 2}}), std::invalid_argument);
  EXPECT_THROW(MeshSurface(corners, {{0, 1, 5}}), std::invalid_argument);
  EXPECT_THROW(MeshSurface(corners, {}), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
