/// Symmetries of parts: two boxes stuck together, and what tells a part from what matches by chance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/detection/matched_region.h"
#include "core/detection/part_search.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// What regions and parts are searched on.
struct SearchedCloud {
  explicit SearchedCloud(const Points& points)
      : edt(points, {}),
        cloud(points, edt, nullptr, nullptr, 1),
        fit(makePlaneFit(cloud, {IspUpdate::PointToPlane, 10'000, 30, 1, 1})) {}

  MatchedRegion region(const ReflectionPlane& plane) const {
    return MatchedRegions(cloud, *fit, 1, 1).largest(cloud.toNormalized(plane));
  }

  GaussianEdt edt;
  NormalizedCloud cloud;
  std::unique_ptr<PlaneFit> fit;
};

/// Two boxes, one turned and put at the side of the other, as dense as that.
struct TwoBoxes {
  Points points;
  std::vector<ReflectionPlane> planes;  ///< three of each

  TwoBoxes() {
    const Eigen::Vector3d large(1.0, 0.7, 0.5), small(0.6, 0.5, 0.35);
    const Points a = box(large, 6000, Sampling::Random, 1).cloud();
    const Points b = box(small, 2900, Sampling::Random, 2).cloud();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.6, Eigen::Vector3d(1.0, 2.0, 0.5).normalized()).toRotationMatrix();
    const Eigen::Vector3d place(1.68, 0.2, 0.1);  // a corner reaches 0.04 into the large box
    points.resize(3, a.cols() + b.cols());
    points.leftCols(a.cols()) = a;
    for (Eigen::Index i = 0; i < b.cols(); ++i)
      points.col(a.cols() + i) = (turn * b.col(i).cast<double>() + place).cast<float>();
    for (int k = 0; k < 3; ++k) {
      planes.emplace_back(Eigen::Vector3d::Unit(k), 0.0);
      planes.emplace_back(turn.col(k), turn.col(k).dot(place));
    }
  }

  /// Whether a plane is within 3 degrees and 2 % of a length of 3.5 of one of a box.
  bool has(const ReflectionPlane& plane) const {
    return std::any_of(planes.begin(), planes.end(), [&](const ReflectionPlane& other) { return same(plane, other); });
  }
  static bool same(const ReflectionPlane& a, const ReflectionPlane& b) {
    const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
    return a.angleTo(b) < 3.0 * kPi / 180.0 && std::abs(a.offset() - sign * b.offset()) < 0.07;
  }
};

TEST(SymmetricParts, AllPlanesOfBothBoxesAreLocal) {
  const TwoBoxes boxes;
  DetectionOptions options;
  options.approximate = true;
  const Detection detection = detectPlanes(boxes.points, options);
  for (const ReflectionPlane& truth : boxes.planes)
    EXPECT_TRUE(std::any_of(detection.planes.begin(), detection.planes.end(), [&](const SymmetryPlane& plane) {
      return plane.kind == PlaneKind::Local && TwoBoxes::same(plane, truth);
    })) << truth.normal().transpose();
  for (const SymmetryPlane& plane : detection.planes)
    EXPECT_TRUE(plane.kind != PlaneKind::Local || boxes.has(plane)) << plane.normal().transpose();
}

TEST(SymmetricParts, AreTheSameForAnyNumberOfThreads) {
  const TwoBoxes boxes;
  const SearchedCloud searched(boxes.points);
  const auto one = findSymmetricParts(searched.cloud, *searched.fit, {IspUpdate::PointToPlane, 1, 1});
  const auto many = findSymmetricParts(searched.cloud, *searched.fit, {IspUpdate::PointToPlane, 1, 3});
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].plane.normal(), many[i].plane.normal());
    EXPECT_EQ(one[i].points, many[i].points);
  }
}

TEST(MatchedRegion, OfASymmetryIsAllOfTheSurfaceAndHasNoEdge) {
  const SearchedCloud searched(box({1.0, 0.7, 0.4}, 8000, Sampling::Random, 3).cloud());
  const MatchedRegion region = searched.region(ReflectionPlane(Eigen::Vector3d::UnitX(), 0.0));
  EXPECT_GT(region.share, 0.99);
  EXPECT_LT(region.edge, 0.05);
  EXPECT_GT(region.support, 0.98);
}

TEST(MatchedRegion, OfAPartEndsWhereThePartEnds) {
  const TwoBoxes boxes;
  const SearchedCloud searched(boxes.points);
  for (std::size_t k = 0; k < boxes.planes.size(); ++k) {
    const MatchedRegion region = searched.region(boxes.planes[k]);
    EXPECT_NEAR(region.share, k % 2 == 0 ? 6000.0 / 8900.0 : 2900.0 / 8900.0, 0.08) << k;
    EXPECT_LT(region.edge, 0.5) << k;
  }
}

TEST(MatchedRegion, OfACapOfAnEllipsoidHasTheEdgeOfADisc) {
  // A plane through the end of a half axis, along it, and turned by 30 degrees about it away from the other half axes,
  // maps the cap about that end: the surface goes on beyond, differently on both sides.
  RandomStream random(5);
  Points points(3, 8000);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Eigen::Vector3d x;
    do x = Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform()) * 2.0 - Eigen::Vector3d::Ones();
    while (x.norm() > 1.0 || x.norm() < 0.1);
    points.col(i) = x.normalized().cwiseProduct(Eigen::Vector3d(1.0, 0.8, 0.6)).cast<float>();
  }
  const MatchedRegion region = SearchedCloud(points).region(
      ReflectionPlane(Eigen::Vector3d(std::cos(kPi / 6.0), std::sin(kPi / 6.0), 0.0), 0.0));
  EXPECT_GT(region.share, 0.05);
  EXPECT_LT(region.share, 0.9);
  EXPECT_GT(region.edge, 0.8);
}

}  // namespace
