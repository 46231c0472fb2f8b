#include "pcl_symmetry/core/mesh_refinement.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/geometry/mesh_sampling.h"

namespace pcl_symmetry {
namespace {

struct Mesh {
  Points vertices;
  std::vector<Eigen::Vector3i> triangles;

  MeshSurface surface() const { return {vertices, triangles}; }
  Points samples(std::uint64_t seed = 1) const { return sampleTriangles(vertices, triangles, 10'000, seed); }
};

Mesh box(float x, float y, float z) {
  Mesh mesh;
  mesh.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i) mesh.vertices.col(i) = Eigen::Vector3f(i & 1 ? x : 0, i & 2 ? y : 0, i & 4 ? z : 0);
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {1, 3, 7}, {1, 7, 5}, {3, 2, 6}, {3, 6, 7}, {2, 0, 4}, {2, 4, 6}};
  return mesh;
}

Mesh polygon(std::vector<Eigen::Vector3f> corners) {
  Mesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(corners.size()));
  for (std::size_t i = 0; i < corners.size(); ++i) mesh.vertices.col(static_cast<Eigen::Index>(i)) = corners[i];
  for (int i = 2; i < static_cast<int>(corners.size()); ++i) mesh.triangles.emplace_back(0, i - 1, i);
  return mesh;
}

Detection planesOf(const Mesh& mesh) {
  Detection found = detectPlanes(mesh.samples());
  refineOnMesh(mesh.surface(), found);
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
  const Detection bar = planesOf(box(30, 2, 1));
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
  const Mesh wedge = polygon({{0, 0, 0}, {3, 0, 0}, {1, 1, 0}});
  Detection found;
  found.tolerance = 0.03;
  SymmetryPlane plane(ReflectionPlane(Eigen::Vector3d::UnitX(), 1.4));
  plane.kind = PlaneKind::Symmetry;
  plane.confidence = 1.0;
  found.planes = {plane};
  refineOnMesh(wedge.surface(), found);
  EXPECT_TRUE(found.planes.empty());
  ASSERT_TRUE(found.best);
  EXPECT_LT(found.best->share, 0.97);
}

}  // namespace
}  // namespace pcl_symmetry
