/// Which planes are symmetries, of the whole or of a part.
#include "core/detection/plane_decision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "core/detection/matched_region.h"
#include "core/detection/part_search.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/shapes.h"
#include "shapes/threads.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// A box with a smooth swelling on one side of the plane x = 0, a plane of symmetry but for that.
/// \param height of the swelling.
Points swollenBox(double height, int num_points) {
  Points points = box({1.0, 0.7, 0.4}, num_points, Sampling::Random, 3).cloud();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (points(0, i) < 0.0f || points(2, i) < 0.399f) continue;
    const double across = std::sin(kPi * points(0, i)), along = std::cos(0.5 * kPi * points(1, i) / 0.7);
    points(2, i) += static_cast<float>(height * across * across * std::min(1.0, 3.0 * along));
  }
  return points;
}

const SymmetryPlane* planeAcrossX(const Detection& detection) {
  for (const SymmetryPlane& plane : detection.planes)
    if (std::abs(plane.normal().x()) > 0.99) return &plane;
  return nullptr;
}

/// Without the points farthest along a direction.
Points cut(const Points& points, double share, const Eigen::Vector3f& direction) {
  std::vector<int> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return direction.dot(points.col(i)) < direction.dot(points.col(j)); });
  order.resize(static_cast<std::size_t>((1.0 - share) * static_cast<double>(order.size())));
  return points(Eigen::all, order);
}

TEST(PlaneJudge, ToleranceDecidesWhatIsSymmetric) {
  // The swelling is 0.047 high; the diameter of the box is 2.57, so that 1 % is 0.026 and 2 % is 0.051. More than 0.026
  // of it covers a half of 1.4 of the surface of 11, which is off on both sides.
  const Points points = swollenBox(0.047, 10'000);
  DetectionOptions options;
  options.tolerance = 0.02;
  const Detection coarse = detectPlanes(points, options);
  ASSERT_NE(planeAcrossX(coarse), nullptr);
  EXPECT_EQ(planeAcrossX(coarse)->kind, PlaneKind::Symmetry);
  EXPECT_NEAR(coarse.tolerance, 0.02 * 2.57, 0.002);
  options.tolerance = 0.01;
  EXPECT_EQ(planeAcrossX(detectPlanes(points, options)), nullptr);
  options.tolerance = 0.01;
  options.absolute_tolerance = 0.05;
  const Detection absolute = detectPlanes(points, options);
  EXPECT_NE(planeAcrossX(absolute), nullptr);
  EXPECT_NEAR(absolute.tolerance, 0.05, 1e-9);
}

TEST(PlaneJudge, ShareAndDeviationAreThoseOfTheSurface) {
  const Detection detection = detectPlanes(box(10'000, Sampling::Random, 2).cloud());
  ASSERT_EQ(detection.planes.size(), 3u);
  for (const SymmetryPlane& plane : detection.planes) {
    EXPECT_GT(plane.share, 0.99);
    EXPECT_LE(plane.share_low, plane.share);
    EXPECT_GE(plane.share_high, plane.share);
    EXPECT_LT(plane.deviation, detection.tolerance);
  }
  EXPECT_FALSE(detection.best.has_value());
}

TEST(PlaneJudge, TheAnswerDoesNotDependOnTheNumberOfPoints) {
  for (const int num_points : {3000, 10'000, 50'000}) {
    EXPECT_EQ(detectPlanes(box(num_points, Sampling::Random, 5).cloud()).planes.size(), 3u) << num_points;
    EXPECT_EQ(planeAcrossX(detectPlanes(swollenBox(0.2, num_points))), nullptr) << num_points;
  }
}

TEST(PlaneJudge, WithoutASymmetryTheBestPlaneIsNamed) {
  const Detection detection = detectPlanes(scaleneTetrahedron(10'000, 1).cloud());
  EXPECT_TRUE(detection.planes.empty());
  ASSERT_TRUE(detection.best.has_value());
  EXPECT_EQ(detection.best->kind, PlaneKind::Approximate);
  EXPECT_GT(detection.best->share, 0.1);
  EXPECT_LT(detection.best->share, 0.9);
  EXPECT_GT(detection.best->deviation, detection.tolerance);
  EXPECT_EQ(detection.best->point_support.size(), 10'000u);
}

TEST(PlaneJudge, ACutCloudKeepsItsPlane) {
  const Shape whole = prism(5, 10'000, Sampling::Random, 4);
  for (const double share : {0.05, 0.2}) {
    const Points rest = cut(whole.cloud(), share, Eigen::Vector3f(0.3f, 0.8f, 0.52f));
    const Detection detection = detectPlanes(rest);
    ASSERT_FALSE(detection.planes.empty()) << share;
    const SymmetryPlane& first = detection.planes.front();
    EXPECT_EQ(first.kind, PlaneKind::Symmetry) << share;
    const bool is_true = std::any_of(whole.planes.begin(), whole.planes.end(), [&](const ReflectionPlane& plane) {
      return planeError(first, plane, Eigen::Vector3d::Zero()).angle < 3.0 * kDegree;
    });
    EXPECT_TRUE(is_true) << share;
  }
}

TEST(PlaneJudge, ACutAsymmetricCloudHasNone) {
  for (const double share : {0.05, 0.2}) {
    const Points rest = cut(scaleneTetrahedron(10'000, 2).cloud(), share, Eigen::Vector3f(0.3f, 0.8f, 0.52f));
    for (const SymmetryPlane& plane : detectPlanes(rest).planes) EXPECT_NE(plane.kind, PlaneKind::Symmetry) << share;
  }
}

TEST(PlaneJudge, ATipThatWasCutOffAThinPartIsMissed) {
  // Two wings as thin as the spacing on a box, the tip of one of them cut off: x = 0 is a plane still.
  Points points(3, 10'000);
  RandomStream random(6);
  Eigen::Index size = 0;
  const Points body = box({0.4, 1.0, 0.4}, 6000, Sampling::Random, 7).cloud();
  for (Eigen::Index i = 0; i < body.cols(); ++i) points.col(size++) = body.col(i);
  while (size < points.cols()) {
    const double x = 1.6 * symmetric(random), y = 0.4 * symmetric(random), side = random.uniform() < 0.5 ? -1.0 : 1.0;
    if (std::abs(x) > 0.4) points.col(size++) = Eigen::Vector3d(x, y - 0.3 * std::abs(x), 0.01 * side).cast<float>();
  }
  const Detection detection = detectPlanes(cut(points, 0.05, Eigen::Vector3f::UnitX()));
  const SymmetryPlane* plane = planeAcrossX(detection);
  ASSERT_NE(plane, nullptr);
  EXPECT_EQ(plane->kind, PlaneKind::Symmetry);
  EXPECT_LT(plane->seen, 0.97);
}

TEST(PlaneJudge, OfAScanWhatStaysInPlaceSaysNothing) {
  // A wall with a block on it, seen from the front. The plane of the wall maps the wall onto itself, and the block to
  // where the wall hides all.
  Points points(3, 5000);
  RandomStream random(8);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double x = symmetric(random), y = symmetric(random);
    const bool is_block = std::abs(x) < 0.4 && y > -0.1 && y < 0.5;
    points.col(i) = Eigen::Vector3d(x, y, is_block ? 0.3 : 0.0).cast<float>();
  }
  const std::optional<Visibility> seen = Visibility::fromPoints(points, Eigen::Vector3d(0.0, 0.0, 6.0));
  ASSERT_TRUE(seen.has_value());
  const DetectionOptions options;
  const GaussianEdt edt(points);
  const NormalizedCloud cloud(points, edt, nullptr, &*seen, 1);
  const std::unique_ptr<PlaneFit> fit =
      makePlaneFit(cloud, {options.expert.update, options.expert.num_refine_samples, options.expert.max_iterations,
                           options.seed, options.num_threads});
  std::vector<Candidate> candidates(2);
  candidates[0].plane = cloud.toNormalized(ReflectionPlane(Eigen::Vector3d::UnitZ(), 0.0));
  candidates[1].plane = cloud.toNormalized(ReflectionPlane(Eigen::Vector3d::UnitX(), 0.0));
  const std::vector<JudgedPlane> judged = PlaneJudge(cloud, *fit, options).judgeWithEvidence(candidates);
  EXPECT_LT(judged[0].evidence.share, 0.1);
  EXPECT_LT(judged[0].plane.confidence, 0.1);
  EXPECT_GT(judged[1].evidence.share, 0.97);
}

TEST(PlaneJudge, AConeWithAFewFoldsIsNotRound) {
  // Radius 1 + 0.12 cos(5 angle) at the base: between its planes D is lower, and so is the share.
  Points points(3, 10'000);
  RandomStream random(11);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double angle = 2.0 * kPi * random.uniform(), height = 1.0 - std::sqrt(random.uniform());
    const double radius = (1.0 - height) * (1.0 + 0.12 * std::cos(5.0 * angle));
    points.col(i) = Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 1.2 * height).cast<float>();
  }
  const Detection detection = detectPlanes(points);
  EXPECT_TRUE(detection.axes.empty());
  EXPECT_EQ(detection.planes.size(), 5u);
}

TEST(PlaneJudge, ChanceIsNoSymmetry) {
  int num_called = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    RandomStream random(seed);
    Points points(3, static_cast<Eigen::Index>(20 + random.below(480)));
    for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = static_cast<float>(random.uniform());
    const Detection detection = detectPlanes(points);
    num_called += !detection.axes.empty() || !detection.centers.empty() ||
                          std::any_of(detection.planes.begin(), detection.planes.end(),
                                      [](const auto& plane) { return plane.kind == PlaneKind::Symmetry; })
                      ? 1
                      : 0;
  }
  EXPECT_EQ(num_called, 0);
}

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
    points << a, ((turn * b.cast<double>()).colwise() + place).cast<float>();
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
  compareThreads([&](int num_threads) {
    const auto parts = findSymmetricParts(searched.cloud, *searched.fit, {IspUpdate::PointToPlane, 1, num_threads});
    return valuesOf(
        parts, [](const SymmetricPart& part) { return part.plane.normal(); }, &SymmetricPart::points);
  });
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
