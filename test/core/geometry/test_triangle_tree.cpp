#include "core/geometry/triangle_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace pcl_symmetry {
namespace {

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
