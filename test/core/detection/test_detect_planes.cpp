/// What detection takes: searches, threads, options that are refused, large clouds, meshes. What it finds is tested
/// through the Python module.
#include "pcl_symmetry/core/detect_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/detection/plane_search.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/triangles.h"
#include "pcl_symmetry/core/mesh_surface.h"
#include "shapes/counting_search.h"
#include "shapes/found_planes.h"
#include "shapes/meshes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(DetectionInput, AGivenSearchIsAskedForEveryKindOfCloud) {
  const Points one = moved(box(3000, Sampling::Random, 4), randomPose(2)).cloud();
  const Shape large = moved(box(30'000, Sampling::Random, 5), randomPose(3));
  for (const auto& [points, num_used] :
       {std::pair(one, 3000), std::pair(joined(one, one), 3000), std::pair(large.cloud(), 20'000)}) {
    AskedSearch asked;
    PlaneInput input(points);
    input.make_search = asked.make();
    const Detection expected = detectPlanes(points), found = detectPlanes(input);
    EXPECT_EQ(asked.num_made, 1);
    EXPECT_EQ(asked.num_points, num_used);
    EXPECT_GT(asked.num_queries, 2 * num_used) << "more than the neighbors of each point";
    ASSERT_EQ(found.planes.size(), expected.planes.size());
    for (std::size_t i = 0; i < found.planes.size(); ++i) {
      EXPECT_LT(found.planes[i].angleTo(expected.planes[i]), 1e-3);
      EXPECT_EQ(found.planes[i].kind, PlaneKind::Symmetry);
      const std::vector<float>& support = found.planes[i].point_support;
      ASSERT_EQ(support.size(), static_cast<std::size_t>(points.cols()));
      EXPECT_GT(meanOf(support), 0.97);
    }
    if (num_used == 20'000) {
      EXPECT_EQ(numFound(large, found.planes, 0.1 * kDegree, 1e-3 * diagonal(points)), 3) << "of the whole cloud";
    }
    AskedSearch asked_with_map;
    const GaussianEdt edt(points);
    input.make_search = asked_with_map.make();
    input.edt = &edt;
    input.map = &expected.map;
    detectPlanes(input);
    EXPECT_GT(asked_with_map.num_queries, 2 * num_used);
  }
}

TEST(DetectPlanes, SameBytesForAnyNumberOfThreads) {
  const Points cloud = moved(prism(5, 4000, Sampling::Random, 13), randomPose(13)).cloud();
  const Points parts = joined(
      cloud, box({0.6, 0.5, 0.35}, 2900, Sampling::Random, 2).cloud().colwise() + Eigen::Vector3f(2.0, 0.2, 0.1));
  const auto detect = [](const Points& points, bool approximate, int num_threads) {
    DetectionOptions options;
    options.approximate = approximate;
    options.num_threads = num_threads;
    return detectPlanes(points, options);
  };
  const auto expectSame = [](const Detection& many, const Detection& one) {
    EXPECT_EQ(many.map.values, one.map.values);
    expectSamePlanes(many.planes, one.planes);
  };
  const Detection whole = detect(cloud, false, 1), of_parts = detect(parts, true, 1);
  EXPECT_EQ(whole.planes.size(), 6u);
  EXPECT_TRUE(std::any_of(of_parts.planes.begin(), of_parts.planes.end(),
                          [](const auto& plane) { return plane.kind == PlaneKind::Local; }));
  expectSame(detect(cloud, false, 8), whole);
  expectSame(detect(parts, true, 8), of_parts);
}

TEST(PlaneInput, HasAMapWithItsDistanceTransform) {
  const Points cloud = box(100, Sampling::Random, 22).cloud();
  const SymmetryMap map;
  PlaneInput input(cloud);
  input.map = &map;
  EXPECT_THROW(detectPlanes(input), std::invalid_argument);
}

TEST(DetectionOptions, RefusesBadOnes) {
  const Points cloud = box(100, Sampling::Random, 22).cloud();
  const auto refused = [&](auto&& change) {
    DetectionOptions options;
    change(options);
    EXPECT_THROW(detectPlanes(cloud, options), std::invalid_argument);
  };
  refused([](auto& o) { o.num_cells = 1; });
  refused([](auto& o) { o.expert.maxima.strength = 2.0; });
  refused([](auto& o) { o.expert.num_phi = 3; });
  refused([](auto& o) { o.expert.max_candidates = 0; });
  refused([](auto& o) { o.expert.num_refine_samples = 9; });
  refused([](auto& o) { o.min_confidence = 1.5; });
  refused([](auto& o) { o.min_confidence = -0.1; });
  refused([](auto& o) { o.min_possible = -0.1; });
  refused([](auto& o) { o.min_possible = 1.1; });
  refused([](auto& o) { o.min_possible = 0.6; });  // above min_confidence
  refused([](auto& o) { o.max_planes = 0; });
  refused([](auto& o) { o.num_threads = -1; });
}

TEST(CloudSubset, TakesAsManyPointsAsTheToleranceNeeds) {
  const Points points = box(90'000, Sampling::Random, 1).cloud();
  DetectionOptions options;
  EXPECT_EQ(drawSubset(points, options)->size(), 20'000u);
  options.tolerance = 0.005;  // half of the spacing: four times as many
  EXPECT_EQ(drawSubset(points, options)->size(), 80'000u);
  options.tolerance = 0.002;
  EXPECT_FALSE(drawSubset(points, options));
  EXPECT_FALSE(drawSubset(points.leftCols(20'000), DetectionOptions()));
}

TEST(CloudSubset, LeavesCloudsOfFewDistinctPoints) {
  EXPECT_FALSE(drawSubset(box(10'000, Sampling::Random, 1).cloud().replicate(1, 5), DetectionOptions()));
}

TEST(CloudSubset, NamesTheNearestPoint) {
  const Points points = moved(prism(5, 30'000, Sampling::Random, 2), randomPose(3)).cloud();
  const Points kept = pointsAt(points, *drawSubset(points, DetectionOptions()));
  const auto search = makeFlannSearch(kept);
  const std::vector<int> nearest = closestPoints(*search, points, 1).index;
  for (std::size_t i = 0; i < nearest.size(); i += 500) {
    const auto sq_distances = (kept.colwise() - points.col(static_cast<Eigen::Index>(i))).colwise().squaredNorm();
    EXPECT_EQ(sq_distances[nearest[i]], sq_distances.minCoeff());
  }
  EXPECT_EQ(nearest, closestPoints(*search, points, 2).index);
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
  const PlaneError error = planeError(found.planes[0], {Eigen::Vector3d::UnitX(), 2.0}, {2.0, 0.0, 0.0});
  EXPECT_LT(error.angle, 1e-5);
  EXPECT_LT(error.offset, 1e-5 * 4.0) << "to what float coordinates resolve";
  EXPECT_GT(found.planes[0].confidence, 0.9);
  EXPECT_EQ(found.planes[1].kind, PlaneKind::Local) << "by support";
  EXPECT_EQ(found.planes[2].kind, PlaneKind::Approximate);
}

}  // namespace
