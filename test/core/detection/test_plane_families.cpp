/// Bodies of revolution and spheres, told from polygons and from bodies with a handle.
#include "core/detection/plane_families.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/turning_shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

const Line3d kLine(Eigen::Vector3d(0.1, -0.05, 0.0), Eigen::Vector3d(0.3, 0.2, 1.0).normalized());

/// Nothing is a symmetry but what \p is_symmetry says; refinement leaves planes alone.
FamilyTest testOf(const std::function<bool(const ReflectionPlane&)>& is_symmetry) {
  const auto share = [is_symmetry](const ReflectionPlane& plane) { return is_symmetry(plane) ? 1.0 : 0.6; };
  return {share, share, [](const ReflectionPlane& plane) { return plane; }, 0.92, 0.03, 0.03};
}

ReflectionPlane through(const Line3d& line, double angle) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  const Eigen::Vector3d n = std::cos(angle) * u + std::sin(angle) * v;
  return ReflectionPlane(n, n.dot(line.origin()));
}

TEST(FindAxes, FindsTheLineOfAllPlanes) {
  const auto test = testOf([](const ReflectionPlane& plane) { return contains(plane, kLine, 0.01); });
  const auto axes = findAxes({through(kLine, 0.3), through(kLine, 1.1), through(kLine, 2.0)}, test);
  ASSERT_EQ(axes.size(), 1u);
  EXPECT_NEAR(std::abs(axes[0].line.direction().dot(kLine.direction())), 1.0, 1e-12);
  EXPECT_LT(kLine.distance(axes[0].line.origin()), 1e-12);
  EXPECT_EQ(axes[0].share, 1.0);
  EXPECT_GE(axes[0].planes.size(), 8u);
  for (const ReflectionPlane& plane : axes[0].planes) EXPECT_TRUE(contains(plane, kLine, 1e-9));
}

TEST(FindAxes, RefinesALineOfRoughPlanes) {
  auto test = testOf([](const ReflectionPlane& plane) { return contains(plane, kLine, 0.03); });
  test.refine = [](const ReflectionPlane& plane) {  // to the plane through the line that is nearest
    const Eigen::Vector3d n = (plane.normal() - plane.normal().dot(kLine.direction()) * kLine.direction()).normalized();
    return ReflectionPlane(n, n.dot(kLine.origin()));
  };
  const auto off = [](const ReflectionPlane& plane, double by) {
    return ReflectionPlane(plane.normal() + by * kLine.direction(), plane.offset() + 0.5 * by);
  };
  const auto axes = findAxes({off(through(kLine, 0.3), 0.015), off(through(kLine, 1.6), -0.015)}, test);
  ASSERT_EQ(axes.size(), 1u);
  EXPECT_NEAR(std::abs(axes[0].line.direction().dot(kLine.direction())), 1.0, 1e-12);
  EXPECT_LT(kLine.distance(axes[0].line.origin()), 1e-9);
}

TEST(FindAxes, APolygonHasNone) {
  for (const int n : {2, 3, 4, 6, 12, 24}) {
    std::vector<ReflectionPlane> planes;
    for (int k = 0; k < n; ++k) planes.push_back(through(kLine, kPi * k / n));
    // A prism forgives half a degree.
    const auto test = testOf([&](const ReflectionPlane& plane) {
      return std::any_of(planes.begin(), planes.end(),
                         [&](const ReflectionPlane& own) { return own.angleTo(plane) < 0.5 * kDegree; });
    });
    EXPECT_TRUE(findAxes(planes, test).empty()) << n;
    EXPECT_FALSE(findCenter(planes, test)) << n;
  }
}

TEST(FindAxes, NeedsTwoPlanes) {
  const auto test = testOf([](const ReflectionPlane&) { return true; });
  EXPECT_TRUE(findAxes({}, test).empty());
  EXPECT_TRUE(findAxes({through(kLine, 0.3)}, test).empty());
  EXPECT_TRUE(findAxes({through(kLine, 0.3), through(kLine, 0.3)}, test).empty()) << "twice the same";
  EXPECT_FALSE(findCenter({through(kLine, 0.3), through(kLine, 1.1)}, test));
}

TEST(FindCenter, FindsThePointOfAllPlanes) {
  const Eigen::Vector3d point(0.2, -0.1, 0.3);
  const auto test = testOf([&](const ReflectionPlane& plane) { return std::abs(plane.signedDistance(point)) < 0.01; });
  RandomStream random(1);
  std::vector<ReflectionPlane> planes;
  for (int k = 0; k < 5; ++k) {
    const Eigen::Vector3d n = randomDirection(random);
    planes.emplace_back(n, n.dot(point));
  }
  const auto center = findCenter(planes, test);
  ASSERT_TRUE(center);
  EXPECT_LT((center->point - point).norm(), 1e-9);
  EXPECT_EQ(center->share, 1.0);
}

TEST(FindCenter, ThreePlanesOfABoxHaveNone) {
  const std::vector<ReflectionPlane> planes = box(1, Sampling::Random, 1).planes;
  const auto test = testOf([&](const ReflectionPlane& plane) {
    return std::any_of(planes.begin(), planes.end(),
                       [&](const ReflectionPlane& own) { return own.angleTo(plane) < 2.0 * kDegree; });
  });
  EXPECT_FALSE(findCenter(planes, test));
  EXPECT_TRUE(findAxes(planes, test).empty());
}

TEST(Contains, IsThreeDegreesAndATolerance) {
  const Line3d z(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  const auto tilted = [](double degrees, double offset) {
    return ReflectionPlane({std::cos(degrees * kDegree), 0.0, std::sin(degrees * kDegree)}, offset);
  };
  EXPECT_TRUE(contains(tilted(2.9, 0.019), z, 0.02));
  EXPECT_FALSE(contains(tilted(3.1, 0.0), z, 0.02));
  EXPECT_FALSE(contains(tilted(0.0, 0.021), z, 0.02));
}

TEST(Families, AThinDiscHasOneAxis) {
  RandomStream random(1);
  Points disc(3, 4000);
  for (Eigen::Index i = 0; i < disc.cols(); ++i) {
    const double angle = 2.0 * kPi * random.uniform(), r = std::sqrt(random.uniform());
    disc.col(i) = Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 0.001 * random.uniform()).cast<float>();
  }
  const Detection detection = detectPlanes(disc);
  ASSERT_EQ(detection.axes.size(), 1u);
  EXPECT_GT(std::abs(detection.axes[0].direction.z()), std::cos(0.5 * kDegree));
}

TEST(Families, AHandleLeavesACupItsOnePlane) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Eigen::Isometry3d pose = randomPose(10 + seed);
    const Shape with = moved(cupShape(true).sampled(8000, seed), pose);
    const Detection one = detectPlanes(with.cloud());
    EXPECT_TRUE(one.axes.empty()) << seed;
    ASSERT_FALSE(one.planes.empty()) << seed;
    EXPECT_EQ(one.planes[0].kind, PlaneKind::Symmetry);
    // The others map all but the handle, 93 % of the surface: nearly symmetric.
    for (std::size_t i = 1; i < one.planes.size(); ++i) EXPECT_NE(one.planes[i].kind, PlaneKind::Symmetry) << seed;
    const PlaneError error =
        planeError(one.planes[0], ReflectionPlane(Eigen::Vector3d::UnitY(), 0.0).transformed(pose), pose.translation());
    EXPECT_LT(error.angle, 0.5 * kDegree) << seed;
    EXPECT_LT(error.offset, 0.01) << seed;

    const Detection all = detectPlanes(moved(cupShape(false).sampled(8000, seed), pose).cloud());
    ASSERT_EQ(all.axes.size(), 1u) << seed;
    EXPECT_TRUE(all.planes.empty()) << seed << ": it is open at one end";
    EXPECT_GT(std::abs(all.axes[0].direction.dot(pose.linear().col(2))), std::cos(0.5 * kDegree)) << seed;
    EXPECT_GT(all.axes[0].confidence, 0.5) << seed;
    EXPECT_GT(all.axes[0].support, 0.9) << seed;
  }
}

TEST(Families, PlanesComeSinglyWhereFamiliesAreOff) {
  DetectionOptions options;
  options.families = false;
  const Detection detection = detectPlanes(cylinder(5000, 1).cloud(), options);
  EXPECT_TRUE(detection.axes.empty());
  EXPECT_GE(detection.planes.size(), 3u);
  const Detection round = detectPlanes(sphere(5000, 1).cloud(), options);
  EXPECT_TRUE(round.centers.empty());
  EXPECT_GE(round.planes.size(), 3u);
}

}  // namespace
