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

TriangleMesh polygon(const std::vector<Eigen::Vector3f>& corners) {
  TriangleMesh mesh{Points(3, corners.size()), {}};
  for (std::size_t i = 0; i < corners.size(); ++i) mesh.vertices.col(i) = corners[i];
  for (int i = 2; i < static_cast<int>(corners.size()); ++i) mesh.triangles.emplace_back(0, i - 1, i);
  return mesh;
}

Detection planesOf(const TriangleMesh& mesh) {
  Detection found = detectPlanes(sampleTriangles(mesh.vertices, mesh.triangles, 10'000));
  refineOnMesh(MeshSurface(mesh.vertices, mesh.triangles), found);
  return found;
}

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

TEST(RefineOnMesh, PlanesOfFlatAndSlenderPartsAreExact) {
  const Detection bar = planesOf(test::boxOfTriangles(30, 2, 1));
  expectPlane(bar, Eigen::Vector3d::UnitX(), 15.0, 30.0);
  expectPlane(bar, Eigen::Vector3d::UnitY(), 1.0, 30.0);
  expectPlane(bar, Eigen::Vector3d::UnitZ(), 0.5, 30.0);
  const Detection rectangle = planesOf(polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}));
  expectPlane(rectangle, Eigen::Vector3d::UnitX(), 1.0, 2.0);
  expectPlane(rectangle, Eigen::Vector3d::UnitY(), 0.5, 2.0);
  const Detection triangle = planesOf(polygon({{1, 1, 0}, {-1, 1, 0}, {0, -1, 0}}));
  expectPlane(triangle, Eigen::Vector3d::UnitX(), 0.0, 2.0);
}

TEST(RefineOnMesh, WhatIsNoSymmetryIsDropped) {
  const TriangleMesh wedge = polygon({{0, 0, 0}, {3, 0, 0}, {1, 1, 0}});
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
  const Detection rod = planesOf(test::boxOfTriangles(100, 1, 1));
  ASSERT_FALSE(rod.planes.empty());
  for (const SymmetryPlane& plane : rod.planes) {
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
