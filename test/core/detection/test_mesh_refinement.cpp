#include "pcl_symmetry/core/detect_planes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/geometry/triangles.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "shapes/meshes.h"

namespace pcl_symmetry {
namespace {

using test::TriangleMesh;

/// Whether a symmetry is this plane, to what float coordinates resolve.
void expectPlane(const Detection& found, const Eigen::Vector3d& normal, double offset, double size) {
  const ReflectionPlane expected(normal, offset);
  for (const SymmetryPlane& plane : found.planes)
    if (plane.kind == PlaneKind::Symmetry && plane.angleTo(expected) < 1e-5 &&
        std::abs(plane.signedDistance(expected.normal() * expected.offset())) < 1e-5 * size) {
      EXPECT_GT(plane.confidence, 0.9);
      return;
    }
  ADD_FAILURE() << normal.transpose() << " " << offset;
}

TEST(RefineOnMesh, WhatIsNoSymmetryIsDropped) {
  const TriangleMesh wedge{(Points(3, 3) << 0, 3, 1, 0, 0, 1, 0, 0, 0).finished(), {{0, 1, 2}}};
  Detection found;
  found.tolerance = 0.03;
  SymmetryPlane plane(ReflectionPlane(Eigen::Vector3d::UnitX(), 1.4));
  plane.kind = PlaneKind::Symmetry;
  plane.confidence = 1.0;
  found.planes = {plane};
  refineOnMesh(MeshSurface(wedge.vertices, wedge.triangles), found);
  EXPECT_TRUE(found.planes.empty());
  ASSERT_TRUE(found.best);
  EXPECT_LT(found.best->share, 0.97);
}

TEST(RefineOnMesh, WhatTheCloudCannotDecideStaysPossible) {
  // A rod is a line at the tolerance, which all planes through it and the one across its middle map onto itself.
  const TriangleMesh rod = test::boxOfTriangles(100, 1, 1);
  Detection found = detectPlanes(sampleTriangles(rod.vertices, rod.triangles, 10'000));
  refineOnMesh(MeshSurface(rod.vertices, rod.triangles), found);
  ASSERT_FALSE(found.planes.empty());
  for (const SymmetryPlane& plane : found.planes) {
    EXPECT_NE(plane.kind, PlaneKind::Symmetry);
    EXPECT_TRUE(std::any_of(plane.reasons.begin(), plane.reasons.end(), [](const Reason& r) { return !r.odds; }));
  }
}

TEST(RefineOnMesh, KeepsTheOrderOfDetection) {
  const TriangleMesh box = test::boxOfTriangles(4, 2, 1);
  const auto plane = [](const Eigen::Vector3d& normal, double offset, PlaneKind kind, double support) {
    SymmetryPlane made(ReflectionPlane(normal, offset));
    made.kind = kind;
    made.support = support;
    made.share = 0.95;
    return made;
  };
  // Samples showed the plane across the longest edge as nearly a symmetry: on the mesh it is one.
  Detection found;
  found.tolerance = 0.04;
  found.best = plane(Eigen::Vector3d::UnitX(), 2.01, PlaneKind::Approximate, 0.9);
  found.planes = {*found.best, plane({1.0, 1.0, 0.0}, 2.0, PlaneKind::Approximate, 0.5),
                  plane(Eigen::Vector3d::UnitY(), 0.3, PlaneKind::Local, 0.7)};
  DetectionOptions options;
  options.approximate = true;
  refineOnMesh(MeshSurface(box.vertices, box.triangles), found, options);
  EXPECT_FALSE(found.best);
  ASSERT_EQ(found.planes.size(), 3u);
  EXPECT_EQ(found.planes[0].kind, PlaneKind::Symmetry);
  expectPlane(found, Eigen::Vector3d::UnitX(), 2.0, 4.0);
  EXPECT_EQ(found.planes[1].kind, PlaneKind::Local) << "by support";
  EXPECT_EQ(found.planes[2].kind, PlaneKind::Approximate);
}

}  // namespace
}  // namespace pcl_symmetry
