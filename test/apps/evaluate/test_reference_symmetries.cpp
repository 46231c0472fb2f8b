#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "apps/support/box_mesh.h"
#include "apps/support/lathe_mesh.h"
#include "apps/support/temporary_folder.h"
#include "common/shape_input/shape_input.h"
#include "core/base/constants.h"
#include "evaluate/mesh/mesh_distance.h"
#include "evaluate/mesh/mesh_reflection.h"
#include "evaluate/references/plane_scan.h"
#include "evaluate/references/reference_cache.h"
#include "evaluate/shared/plane_difference.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

pcl::PolygonMesh meshOf(const std::string& off) {
  const TemporaryFolder folder;
  return *loadShape(folder.write("mesh.off", off)).mesh;
}

TEST(MeshDistance, IsExactAtFacesEdgesAndCorners) {
  const TriangleScene scene(boxMesh({1.0f, 1.0f, 1.0f}, {5.0f, 0.0f, 0.0f}));
  const MeshDistance distance(scene);
  const double half = 0.5 / std::sqrt(3.0);  // in a scene of unit diagonal around the origin
  const auto check = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& expected) {
    const auto closest = distance.closest(x);
    ASSERT_TRUE(closest);
    EXPECT_LT((closest->point - expected).norm(), 1e-6) << x.transpose();
    EXPECT_NEAR(closest->distance, (x - expected).norm(), 1e-6);
    EXPECT_TRUE(distance.within(x, closest->distance + 1e-6));
    EXPECT_FALSE(distance.within(x, closest->distance - 1e-6));
    EXPECT_FALSE(distance.closest(x, closest->distance - 1e-6));
  };
  check({0.1, 0.05, 0.9}, {0.1, 0.05, half});
  check({0.1, 0.05, 0.2}, {0.1, 0.05, half});
  check({0.7, 0.05, 0.9}, {half, 0.05, half});
  check({-0.7, 0.8, 0.9}, {-half, half, half});
  EXPECT_NEAR(std::abs(distance.closest({0.1, 0.05, 0.9})->normal.z()), 1.0, 1e-6);
}

TEST(MeshDistance, ClosestPointOfATriangle) {
  const Triangle triangle{{0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 2.0, 0.0}};
  const auto is = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& expected) {
    EXPECT_LT((closestPoint(triangle, x) - expected).norm(), 1e-12) << x.transpose();
  };
  is({0.5, 0.5, 3.0}, {0.5, 0.5, 0.0});
  is({-1.0, -1.0, 1.0}, {0.0, 0.0, 0.0});
  is({3.0, -1.0, 1.0}, {2.0, 0.0, 0.0});
  is({-1.0, 3.0, 1.0}, {0.0, 2.0, 0.0});
  is({1.0, -1.0, 1.0}, {1.0, 0.0, 0.0});
  is({-1.0, 1.0, 1.0}, {0.0, 1.0, 0.0});
  is({2.0, 2.0, 1.0}, {1.0, 1.0, 0.0});
}

TEST(ReferenceSymmetries, ABoxHasThreePlanes) {
  const Eigen::Vector3f center(10.0f, -20.0f, 5.0f);
  const ReferenceSymmetries box = findReferenceSymmetries(boxMesh({1.0f, 1.5f, 2.0f}, center));
  EXPECT_EQ(box.kind, SymmetryKind::Symmetric);
  EXPECT_LT((box.center - center.cast<double>()).norm(), 1e-6);
  EXPECT_NEAR(box.diagonal, std::sqrt(29.0), 1e-6);
  ASSERT_EQ(box.planes.size(), 3u);
  EXPECT_TRUE(box.axes.empty() && box.centers.empty());
  for (int axis = 0; axis < 3; ++axis) {
    int count = 0;
    for (const ReferencePlane& reference : box.planes) {
      const Difference d =
          difference(reference.plane, ReflectionPlane(Eigen::Vector3d::Unit(axis), center[axis]), box.center);
      count += d.within(1e-3 * kDegree, 1e-4) ? 1 : 0;
      EXPECT_GT(reference.share, 0.999);
    }
    EXPECT_EQ(count, 1) << axis;
  }
}

TEST(ReferenceSymmetries, TheToleranceIsAShareOfTheDiameterOrTheDiagonal) {
  // The diameter of this tetrahedron is its longest edge, from (2, 0.1, 0) to (0, 0, 0); its box is 2 by 1.3 by 0.9.
  const pcl::PolygonMesh mesh = meshOf(tetrahedronOFF());
  ReferenceOptions options;
  const ReferenceSymmetries of_diameter = findReferenceSymmetries(mesh, options);
  EXPECT_NEAR(of_diameter.diameter, std::sqrt(4.01), 1e-5);
  EXPECT_NEAR(of_diameter.tolerance, 0.01 * std::sqrt(4.01), 1e-7);
  options.tolerance_in_diagonals = true;
  EXPECT_NEAR(findReferenceSymmetries(mesh, options).tolerance, 0.01 * std::sqrt(4.0 + 1.69 + 0.81), 1e-7);
}

TEST(ReferenceSymmetries, BruteForceAndTheTransformAgreeOnABox) {
  ReferenceOptions options;
  options.by_transform = true;
  const pcl::PolygonMesh mesh = boxMesh({1.0f, 1.5f, 2.0f});
  EXPECT_EQ(findReferenceSymmetries(mesh, options).planes.size(), findReferenceSymmetries(mesh).planes.size());
}

TEST(PlaneScan, TheBestPlanesOfABoxAreItsOwn) {
  const TriangleScene scene(boxMesh({1.0f, 1.5f, 2.0f}));
  const MeshReflection reflection(scene, 5000, 1);
  const std::vector<ScannedPlane> planes = scanPlanes(scene, reflection.samples(), 0);
  ASSERT_GE(planes.size(), 3u);
  for (int axis = 0; axis < 3; ++axis) {
    const auto found = std::find_if(planes.begin(), planes.begin() + 3, [&](const ScannedPlane& scanned) {
      // The grid is two degrees and 1 % wide: the best plane of it lies within one step of each.
      return difference(scanned.plane, ReflectionPlane(Eigen::Vector3d::Unit(axis), 0.0), Eigen::Vector3d::Zero())
          .within(2.0 * kDegree, 0.01);
    });
    EXPECT_NE(found, planes.begin() + 3) << axis;
  }
  EXPECT_TRUE(std::is_sorted(planes.begin(), planes.end(),
                             [](const auto& a, const auto& b) { return a.closeness > b.closeness; }));
}

TEST(MeshReflection, ClimbsToTheGreatestShare) {
  const TriangleScene scene(boxMesh({1.0f, 1.5f, 2.0f}));
  const MeshReflection reflection(scene, 2000, 1);
  const ReflectionPlane off(Eigen::Vector3d(1.0, 0.03, -0.02), 0.006);
  ASSERT_LT(reflection.share(off, 0.01), 0.9);
  EXPECT_GT(reflection.share(reflection.climb(off, 0.01, 1), 0.01), 0.97);
}

TEST(ReferenceSymmetries, ACubeHasNine) {
  EXPECT_EQ(findReferenceSymmetries(boxMesh({1.0f, 1.0f, 1.0f})).planes.size(), 9u);
}

TEST(ReferenceSymmetries, ATetrahedronHasNone) {
  const ReferenceSymmetries none = findReferenceSymmetries(meshOf(tetrahedronOFF()));
  EXPECT_EQ(none.kind, SymmetryKind::Asymmetric);
  EXPECT_TRUE(none.planes.empty() && none.axes.empty() && none.centers.empty());
  EXPECT_LT(none.best_share, 0.9);
  EXPECT_GT(none.best_share, 0.1);
}

TEST(ReferenceSymmetries, AVaseHasAnAxisAndASphereACenter) {
  const ReferenceSymmetries vase = findReferenceSymmetries(meshOf(vaseOFF()));
  EXPECT_TRUE(vase.planes.empty() && vase.centers.empty());
  ASSERT_EQ(vase.axes.size(), 1u);
  const Line3d axis(vase.axes[0].point, vase.axes[0].direction);
  EXPECT_TRUE(difference(Line3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()), axis, vase.center)
                  .within(0.05 * kDegree, 1e-3 * vase.diagonal));
  const ReferenceSymmetries sphere = findReferenceSymmetries(meshOf(sphereOFF()));
  EXPECT_TRUE(sphere.planes.empty() && sphere.axes.empty());
  ASSERT_EQ(sphere.centers.size(), 1u);
  EXPECT_LT(sphere.centers[0].point.norm(), 1e-3);
}

TEST(ReferenceSymmetries, MoveWithTheMeshAndSurviveTheCache) {
  const TemporaryFolder folder;
  ReferenceOptions options;
  const ReferenceSymmetries box = findReferenceSymmetries(boxMesh({1.0f, 1.5f, 2.0f}), options);
  {
    ReferenceCache cache(folder / "r.json", options);
    EXPECT_FALSE(cache.find("a/box.off", 6));
    cache.add("a/box.off", 6, box);
    cache.save();
  }
  const ReferenceCache cache(folder / "r.json", options);
  EXPECT_FALSE(cache.find("a/box.off", 7)) << "another mesh of this name";
  const auto read = cache.find("a/box.off", 6);
  ASSERT_TRUE(read);
  EXPECT_EQ(toJson(*read), toJson(box));
  options.tolerance = 0.02;
  EXPECT_THROW(ReferenceCache(folder / "r.json", options), InputError);

  Eigen::Isometry3d motion(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
  motion.pretranslate(Eigen::Vector3d(4.0, 5.0, 6.0));
  const ReferenceSymmetries moved = box.transformed(motion);
  EXPECT_LT((moved.center - motion * box.center).norm(), 1e-12);
  for (std::size_t i = 0; i < box.planes.size(); ++i)
    EXPECT_NEAR(moved.planes[i].plane.signedDistance(motion * box.center), 0.0, 1e-3)
        << "the planes of a box meet in its center";
}

}  // namespace
