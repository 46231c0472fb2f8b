/// Bodies of revolution, spheres and regular polygons, told from each other and from bodies with a handle.
#include "core/detection/plane_families.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/detection/plane_decision.h"
#include "core/detection/plane_search.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/counting_search.h"
#include "shapes/searched_shape.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

const Line3d kLine(Eigen::Vector3d(0.1, -0.05, 0.0), Eigen::Vector3d(0.3, 0.2, 1.0).normalized());

/// Nothing is a symmetry but what \p is_symmetry says; refinement leaves planes alone.
FamilyTest testOf(const std::function<bool(const ReflectionPlane&)>& is_symmetry) {
  const auto share = [is_symmetry](const ReflectionPlane& plane) { return is_symmetry(plane) ? 1.0 : 0.6; };
  return {share, share, [](const ReflectionPlane& plane) { return plane; }, 0.92, 0.03};
}

TEST(FindAxes, RefinesALineOfRoughPlanes) {
  auto test = testOf([](const ReflectionPlane& plane) { return contains(plane, kLine); });
  test.refine = [](const ReflectionPlane& plane) {  // to the plane through the line that is nearest
    const Eigen::Vector3d n = (plane.normal() - plane.normal().dot(kLine.direction()) * kLine.direction()).normalized();
    return ReflectionPlane(n, n.dot(kLine.origin()));
  };
  const auto off = [](const ReflectionPlane& plane, double by) {
    return ReflectionPlane(plane.normal() + by * kLine.direction(), plane.offset() + 0.5 * by);
  };
  const auto axes = findAxes({off(planeThrough(kLine, 0.3), 0.015), off(planeThrough(kLine, 1.6), -0.015)}, test);
  ASSERT_EQ(axes.size(), 1u);
  EXPECT_NEAR(std::abs(axes[0].common.direction().dot(kLine.direction())), 1.0, 1e-12);
  EXPECT_LT(kLine.distance(axes[0].common.origin()), 1e-9);
}

TEST(FindAxes, NeedsTwoPlanes) {
  const auto test = testOf([](const ReflectionPlane&) { return true; });
  EXPECT_TRUE(findAxes({}, test).empty());
  EXPECT_TRUE(findAxes({planeThrough(kLine, 0.3)}, test).empty());
  EXPECT_TRUE(findAxes({planeThrough(kLine, 0.3), planeThrough(kLine, 0.3)}, test).empty()) << "twice the same";
  EXPECT_FALSE(findCenter({planeThrough(kLine, 0.3), planeThrough(kLine, 1.1)}, test));
}

TEST(Contains, IsThreeDegreesAndThreeHundredths) {
  const Line3d z(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  const auto tilted = [](double degrees, double offset) {
    return ReflectionPlane({std::cos(degrees * kDegree), 0.0, std::sin(degrees * kDegree)}, offset);
  };
  EXPECT_TRUE(contains(tilted(2.9, 0.029), z));
  EXPECT_FALSE(contains(tilted(3.1, 0.0), z));
  EXPECT_FALSE(contains(tilted(0.0, 0.031), z));
}

/// The wall of a wheel: a radius of 1 + depth cos(num_teeth angle), 0.6 high, with Gaussian noise. Where \p thinned,
/// density falls to a quarter from one side to the other.
Points wheel(int num_teeth, double depth, double noise, bool thinned, std::uint64_t seed) {
  constexpr int kNumPoints = 10'000;
  RandomStream random(seed);
  Points points(3, kNumPoints);
  for (Eigen::Index i = 0; i < kNumPoints;) {
    const double angle = 2.0 * kPi * random.uniform(), r = 1.0 + depth * std::cos(num_teeth * angle);
    const Eigen::Vector3d x(r * std::cos(angle), r * std::sin(angle), 0.6 * random.uniform());
    if (thinned && random.uniform() > 0.625 + 0.375 * x.x()) continue;
    points.col(i++) = (x + noise * Eigen::Vector3d(gaussian(random), gaussian(random), gaussian(random))).cast<float>();
  }
  return points;
}

DetectionOptions manyPlanes() {
  DetectionOptions options;
  options.max_planes = 64;
  options.num_threads = 1;
  return options;
}

/// Of a noisy cloud that is thinner on one side, fewer points decide, which FLANN finds: the search of the user is made
/// for all of them, once.
TEST(Polygons, AGivenSearchIsMadeOnceWhereTheDensityIsUneven) {
  AskedSearch asked;
  const Points points = wheel(12, 0.12, 0.03, true, 2);
  PlaneInput input(points);
  input.make_search = asked.make();
  const Detection found = detectPlanes(input, manyPlanes());
  EXPECT_EQ(found.planes.size(), 13u);
  EXPECT_EQ(asked.num_made, 1);
  EXPECT_EQ(asked.num_points, points.cols());
}

/// Whose planes are searched, upright ones through the origin among them.
struct SearchedPoints : SearchedShape {
  explicit SearchedPoints(const Points& points) : SearchedShape(points, manyPlanes()) {}

  SymmetryPlane symmetry(double angle) const {
    SymmetryPlane plane(ReflectionPlane({std::cos(angle), std::sin(angle), 0.0}, 0.0));
    setConfidence(plane, 0.9, "test", options);
    return plane;
  }
};

TEST(WithoutPlanesThrough, TakesThePlanesOfAnAxis) {
  const SearchedPoints searched(cylinder(1000, 1).cloud());
  SymmetryAxis axis;
  axis.point = Eigen::Vector3d::Zero();
  axis.direction = Eigen::Vector3d::UnitZ();
  SymmetryPlane across(ReflectionPlane(Eigen::Vector3d::UnitZ(), 0.0));
  const auto kept =
      withoutPlanesThrough({searched.symmetry(0.3), across, searched.symmetry(2.0)}, {axis}, searched.cloud);
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].angleTo(across), 0.0);
}

TEST(FindFamilies, OfACanWithANozzleOnePlaneIsASymmetry) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Points nozzle = box({0.2, 0.1, 0.1}, 350, Sampling::Random, seed).cloud();
    nozzle.colwise() += Eigen::Vector3f(0.7F, 0.0F, 0.8F);
    const auto sticksOut = [](const Eigen::Vector3f& x) { return x.head<2>().norm() > 0.6F; };
    const Detection found =
        detectPlanes({joined(cylinder(8000, seed).cloud(), pointsWhere(nozzle, sticksOut))}, manyPlanes());
    EXPECT_TRUE(found.axes.empty());
    ASSERT_GT(found.planes.size(), 1u);
    EXPECT_EQ(found.planes[0].kind, PlaneKind::Symmetry);
    EXPECT_LT(found.planes[0].angleTo(ReflectionPlane(Eigen::Vector3d::UnitY(), 0.0)), 0.02);
    EXPECT_NE(found.planes[1].kind, PlaneKind::Symmetry);
  }
}

TEST(CompletePolygon, PlanesOfANoisyPolygonAreJudgedTogether) {
  const SearchedPoints searched(wheel(7, 0.1, 0.04, false, 6));
  ASSERT_EQ(searched.cloud.kind(), CloudKind::Volume);
  SymmetryPlane first = searched.symmetry(0.5 * kPi), second = searched.symmetry(0.5 * kPi + kPi / 7.0);
  DetectionState completed;
  completed.answer.planes = {first, second};
  completePolygon(searched, completed);
  ASSERT_TRUE(completed.polygon);
  EXPECT_EQ(completed.polygon->fold, 7);
  EXPECT_EQ(completed.answer.planes.size(), 7u);
  for (const SymmetryPlane& plane : completed.answer.planes) EXPECT_EQ(plane.kind, PlaneKind::Symmetry);
}

TEST(FoldSpectrum, ToldFromARoundBody) {
  const auto foldOf = [](const Points& points) {
    const auto polygon = polygonBySpectrum(points, Line3d(Eigen::Vector3d(0.0, 0.0, 0.3), Eigen::Vector3d::UnitZ()));
    return polygon ? polygon->fold : 0;
  };
  for (const int n : {3, 7, 16}) EXPECT_EQ(foldOf(wheel(n, 0.1, 0.04, false, 6)), n);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) EXPECT_EQ(foldOf(wheel(1, 0.0, 0.04, false, seed)), 0);
  EXPECT_EQ(foldOf(wheel(2, 0.2, 0.04, false, 7)), 0) << "two planes are no polygon";
}

}  // namespace
