#include "pcl_symmetry/core/symmetrized_shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/geometry/mesh_sampling.h"
#include "core/geometry/triangle_tree.h"
#include "shapes/meshes.h"

namespace pcl_symmetry {
namespace {

const ReflectionPlane kPlane(Eigen::Vector3d::UnitX(), 0.0);

/// A spheroid of semi-axes 1, 0.8, 0.6 whose vertices x -> -x maps onto each other, with a bump on its right side: a
/// cosine of \p height along the normal, as wide as \p radius.
test::TriangleMesh bumped(int rings, int around, double height, double radius) {
  test::TriangleMesh mesh{Points(3, rings * around), {}};
  const Eigen::Vector3d axes(1.0, 0.8, 0.6), top(1.0, 0.0, 0.0);
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < around; ++k) {
      const double theta = kPi * (i + 0.5) / rings, phi = 2.0 * kPi * (k + 0.5) / around;
      const Eigen::Vector3d on_sphere(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                      std::cos(theta));
      const Eigen::Vector3d x = axes.cwiseProduct(on_sphere), normal = on_sphere.cwiseQuotient(axes).normalized();
      const double share = std::min(1.0, (x - top).norm() / radius);
      mesh.vertices.col(i * around + k) = (x + 0.5 * height * (1.0 + std::cos(kPi * share)) * normal).cast<float>();
    }
  for (int i = 0; i + 1 < rings; ++i)
    for (int k = 0; k < around; ++k) {
      const int a = i * around + k, b = i * around + (k + 1) % around;
      // The diagonals of both sides are reflections of each other.
      if (4 * k < around || 4 * k >= 3 * around) {
        mesh.triangles.emplace_back(a, a + around, b);
        mesh.triangles.emplace_back(b, a + around, b + around);
      } else {
        mesh.triangles.emplace_back(a, a + around, b + around);
        mesh.triangles.emplace_back(a, b + around, b);
      }
    }
  return mesh;
}

TEST(SymmetrizedMesh, IsItsOwnReflection) {
  const test::TriangleMesh mesh = bumped(100, 200, 0.05, 0.6);
  for (const SymmetrizedHalf half : {SymmetrizedHalf::Mean, SymmetrizedHalf::Left, SymmetrizedHalf::Right}) {
    const SymmetrizedShape shape = symmetrizedMesh(mesh.vertices, mesh.triangles, kPlane, half);
    EXPECT_LT(shape.deviation, 1e-5 * 2.0) << "of the diameter";
    const TriangleTree tree(shape.points, mesh.triangles);
    const Points points = sampleTriangles(shape.points, mesh.triangles, 2000);
    double mean = 0.0;
    for (Eigen::Index i = 0; i < points.cols(); ++i)
      mean +=
          std::sqrt(tree.closestTo(kPlane.reflect(points.col(i).cast<double>()).cast<float>()).sq_distance) / 2000.0;
    EXPECT_LT(mean, 1e-5 * 2.0);
    // How high the bump is on both sides.
    const float expected = half == SymmetrizedHalf::Mean ? 1.025f : half == SymmetrizedHalf::Left ? 1.0f : 1.05f;
    EXPECT_NEAR(shape.points.row(0).maxCoeff(), expected, 1e-3);
    EXPECT_NEAR(shape.points.row(0).minCoeff(), -expected, 1e-3);
  }
}

/// A ball whose triangles the plane x = 0.3 z does not map onto each other.
TEST(MirroredHalf, IsItsOwnReflectionWhateverTheTriangles) {
  const test::TriangleMesh mesh = bumped(100, 200, 0.0, 0.6);
  const ReflectionPlane tilted(Eigen::Vector3d(1.0, 0.0, -0.3).normalized(), 0.0);
  for (const bool left : {true, false}) {
    const MirroredMesh half = mirroredHalf(mesh.vertices, mesh.triangles, tilted, left);
    const TriangleTree tree(half.vertices, half.triangles);
    for (Eigen::Index i = 0; i < half.vertices.cols(); ++i) {
      const Eigen::Vector3d x = half.vertices.col(i).cast<double>();
      EXPECT_LT(std::sqrt(tree.closestTo(tilted.reflect(x).cast<float>()).sq_distance), 1e-6);
      const Eigen::Vector3d source = mesh.vertices.col(half.sources[i]).cast<double>();
      EXPECT_LT(std::min((x - source).norm(), (tilted.reflect(x) - source).norm()), 0.04) << "an edge";
    }
    EXPECT_EQ(openEdges(half.vertices, half.triangles).size(), 2u * 200u)
        << "the holes at the poles, or their reflections";
  }
}

TEST(ReflectedPairs, FindsWhatIsThere) {
  Points points(3, 4);
  points << 1, -1.001f, 2, 0, 0, 0, 1, 3, 0, 0, 0, 0;
  const ReflectedPairs pairs = reflectedPairs(points, kPlane, 0.01);
  EXPECT_EQ(pairs.index, (std::vector<int>{1, 0, -1, 3}));
  EXPECT_NEAR(pairs.sq_distances[0], 1e-6, 1e-8);
  EXPECT_THROW(reflectedPairs(points, kPlane, -1.0), std::invalid_argument);
}

TEST(LandmarkAsymmetry, MeasuresPairsAndTheMidline) {
  const LandmarkAsymmetry found = landmarkAsymmetry({{{1.0, 0.0, 0.0}, {-1.0, 0.3, 0.4}}}, {{0.5, 0.0, 0.0}}, kPlane);
  EXPECT_TRUE(found.paired[0].isApprox(Eigen::Vector3d(0.0, -0.3, -0.4)));
  EXPECT_NEAR(found.paired_rms, 0.5, 1e-12);
  EXPECT_NEAR(found.unpaired[0], 0.5, 1e-12);
  EXPECT_NEAR(found.object_rms, std::sqrt((2.0 * 0.25 * 0.25 + 0.25) / 3.0), 1e-12);
  EXPECT_EQ(landmarkAsymmetry({}, {}, kPlane).object_rms, 0.0);
}

}  // namespace
}  // namespace pcl_symmetry
