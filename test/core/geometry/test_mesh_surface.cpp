/// Surfaces of triangles: how motions map them, points spread over them, and rays that meet them.
#include "pcl_symmetry/core/mesh_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/geometry/triangles.h"
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
  EXPECT_EQ(mesh.shares({Eigen::Vector3d::UnitX(), 1.1}, 0.01, 0.9).share, shares(1.1).share);
}

TEST(MeshSurface, RefusesWhatIsNoSurface) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Points corners(3, 3);
  corners << 0, 1, 0, 0, 0, nan, 0, 0, 0;
  EXPECT_THROW(MeshSurface(corners, {{0, 1, 2}}), std::invalid_argument);
  EXPECT_THROW(MeshSurface(corners, {{0, 1, 5}}), std::invalid_argument);
  EXPECT_THROW(MeshSurface(corners, {}), std::invalid_argument);
}

TEST(SampleTriangles, SpreadsPointsByArea) {
  // Two triangles of areas 1 and 3: one point in each of equal shares of the area, so that the counts are exact.
  const Points vertices = (Points(3, 5) << 0, 2, 0, 6, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1).finished();
  const Points points = sampleTriangles(vertices, {{0, 1, 2}, {0, 3, 4}}, 4000);
  ASSERT_EQ(points.cols(), 4000);
  EXPECT_GE(points.minCoeff(), 0.0f);
  const Points first = points.leftCols(1000), second = points.rightCols(3000);  // in the order of the triangles
  EXPECT_TRUE(first.row(2).isZero(0.0f) && second.row(1).isZero(0.0f));
  EXPECT_LE((0.5f * first.row(0) + first.row(1)).maxCoeff(), 1.0f + 1e-6f);
  EXPECT_LE((second.row(0) / 6.0f + second.row(2)).maxCoeff(), 1.0f + 1e-6f);
  const Eigen::Vector3d mean = first.cast<double>().rowwise().mean();
  // Uniform in the triangle: its centroid, with standard deviations of 2 / sqrt(18 * 1000) and half of it.
  EXPECT_NEAR(mean.x(), 2.0 / 3.0, 4.0 * 0.015);
  EXPECT_NEAR(mean.y(), 1.0 / 3.0, 4.0 * 0.0075);
  EXPECT_EQ(sampleTriangles(vertices, {{0, 1, 2}, {0, 3, 4}}, 4000), points);
  EXPECT_NE(sampleTriangles(vertices, {{0, 1, 2}, {0, 3, 4}}, 4000, 2), points);
}

TEST(SampleTriangles, LeavesOutWhatIsNotFinite) {
  Points vertices(3, 4);
  vertices << 0, 2, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1;
  vertices(0, 3) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(sampleTriangles(vertices, {{0, 1, 2}, {0, 1, 3}}, 100).allFinite());
}

TEST(SampleTriangles, RefusesWhatHasNoSurface) {
  const Points vertices = (Points(3, 3) << 0, 2, 1, 0, 0, 0, 0, 0, 0).finished();
  EXPECT_THROW(sampleTriangles(vertices, {{0, 1, 2}}, 10), std::invalid_argument);  // on a line
  EXPECT_THROW(sampleTriangles(vertices, {}, 10), std::invalid_argument);
  EXPECT_THROW(sampleTriangles(vertices, {{0, 1, 3}}, 10), std::invalid_argument);
  EXPECT_THROW(sampleTriangles(vertices, {{0, -1, 2}}, 10), std::invalid_argument);
}

/// Random triangles in the unit cube.
struct Scene {
  explicit Scene(int count) : corners(3, 3 * count) {
    RandomStream random(9);
    for (int t = 0; t < count; ++t) {
      const Eigen::Vector3f at(draw(random), draw(random), draw(random));
      for (int k = 0; k < 3; ++k)
        corners.col(3 * t + k) = at + 0.2f * Eigen::Vector3f(draw(random), draw(random), draw(random));
      triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
  }
  static float draw(RandomStream& random) { return static_cast<float>(random.uniform()); }

  Points corners;
  std::vector<Eigen::Vector3i> triangles;
};

/// By solving origin + t direction = a + x u + y v for every triangle.
RayHit closestByTrial(const Scene& scene, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
  RayHit best;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const Eigen::Vector3d a = scene.corners.col(3 * t).cast<double>();
    Eigen::Matrix3d system;
    system << -direction.cast<double>(), scene.corners.col(3 * t + 1).cast<double>() - a,
        scene.corners.col(3 * t + 2).cast<double>() - a;
    const Eigen::Vector3d solution = system.inverse() * (origin.cast<double>() - a);
    if (solution[1] < 0 || solution[2] < 0 || solution[1] + solution[2] > 1 || solution[0] <= 0) continue;
    if (solution[0] < best.distance) best = {static_cast<int>(t), static_cast<float>(solution[0])};
  }
  return best;
}

TEST(TriangleTree, FindsWhatTryingEveryTriangleFinds) {
  const Scene scene(300);
  const TriangleTree tree(scene.corners, scene.triangles);
  RandomStream random(2);
  int num_hits = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3f from(Scene::draw(random), Scene::draw(random), -0.5f);
    const Eigen::Vector3f to(Scene::draw(random), Scene::draw(random), 1.5f);
    const RayHit hit = tree.closest(from, to - from), expected = closestByTrial(scene, from, to - from);
    ASSERT_EQ(hit.triangle, expected.triangle);
    EXPECT_EQ(tree.blocks(from, to), expected.triangle >= 0 && expected.distance < 1.0f);
    if (hit.triangle < 0) continue;
    ++num_hits;
    EXPECT_NEAR(hit.distance, expected.distance, 1e-4);
    EXPECT_NE(tree.closest(from, to - from, hit.distance * 1.001f).triangle, hit.triangle) << "nearer ones are over";
  }
  EXPECT_GT(num_hits, 100);
  EXPECT_LT(num_hits, 500);
}

/// The closest point of a triangle has three conditions: it lies in it, and no way along u and v comes closer.
TEST(TriangleTree, FindsTheClosestPointThatTryingEveryTriangleFinds) {
  const Scene scene(300);
  const TriangleTree tree(scene.corners, scene.triangles);
  RandomStream random(3);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3f x(2.0f * Scene::draw(random), 2.0f * Scene::draw(random), 2.0f * Scene::draw(random));
    float least = 100.0f;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
      for (int j = 0; j <= 40; ++j)
        for (int k = 0; j + k <= 40; ++k)
          least = std::min(least, (scene.corners.middleCols<3>(3 * static_cast<Eigen::Index>(t)) *
                                       (Eigen::Vector3f(40 - j - k, j, k) / 40.0f) -
                                   x)
                                      .norm());
    const ClosestOnTriangles found = tree.closestTo(x);
    EXPECT_NEAR(std::sqrt(found.sq_distance), least, 0.01) << "as fine as points are tried";
    EXPECT_LE(std::sqrt(found.sq_distance), least + 1e-5);
    EXPECT_NEAR((found.point - x).squaredNorm(), found.sq_distance, 1e-5);
  }
  const std::vector<Eigen::Vector3i> segment{{0, 1, 1}};
  Points ends(3, 2);
  ends << 0, 2, 0, 0, 0, 0;
  EXPECT_TRUE(TriangleTree(ends, segment).closestTo({0.5f, 1.0f, 0.0f}).point.isApprox(Eigen::Vector3f(0.5f, 0, 0)));
}

TEST(TriangleTree, EmptyAndDegenerateScenesBlockNothing) {
  const Points corners = Points::Ones(3, 3);
  const Eigen::Vector3f from(0, 0, 0), to(2, 2, 2);
  const std::vector<Eigen::Vector3i> none, points(100, Eigen::Vector3i(0, 1, 2));
  EXPECT_FALSE(TriangleTree(corners, none).blocks(from, to));
  EXPECT_FALSE(TriangleTree(corners, points).blocks(from, to));
}

}  // namespace
}  // namespace pcl_symmetry
