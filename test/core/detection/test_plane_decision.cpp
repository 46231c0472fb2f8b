/// Which planes are symmetries, of the whole or of a part.
#include "core/detection/plane_decision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/judged_cloud.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(PlaneDecision, PointsOfAScanThatStayInPlaceAreUninformative) {
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
  const JudgedShape scan(points, {}, &*seen);
  std::vector<Candidate> candidates(2);
  candidates[0].plane = scan.normalized(Eigen::Vector3d::UnitZ(), 0.0);
  candidates[1].plane = scan.normalized(Eigen::Vector3d::UnitX(), 0.0);
  const std::vector<MeasuredPlane> judged = scan.decision.judge(candidates);
  EXPECT_LT(judged[0].evidence.share, 0.1);
  EXPECT_LT(judged[0].plane.confidence, 0.1);
  EXPECT_GT(judged[1].evidence.share, 0.97);
}

/// A plane of a fan about z; its support names it.
SymmetryPlane planeOfFan(int k, PlaneKind kind, double confidence, double support) {
  const double angle = k * kPi / 6.0;
  SymmetryPlane plane(ReflectionPlane(Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0), 0.0));
  plane.kind = kind;
  plane.confidence = confidence;
  plane.support = support;
  return plane;
}

TEST(RankedPlanes, BestFirstAndEachOnce) {
  const std::vector<SymmetryPlane> planes = {
      planeOfFan(0, PlaneKind::Approximate, 0.1, 0.7),
      planeOfFan(1, PlaneKind::Possible, 0.3, 0.1),
      planeOfFan(2, PlaneKind::Symmetry, 0.6, 0.2),
      planeOfFan(3, PlaneKind::Possible, 0.4, 0.4),  // the plane of the next one, which is better
      planeOfFan(3, PlaneKind::Symmetry, 0.9, 0.3),
      planeOfFan(4, PlaneKind::Local, 0.0, 0.8),
      planeOfFan(4, PlaneKind::Approximate, 0.1, 0.85),  // is reported as the plane of a part
      planeOfFan(5, PlaneKind::Symmetry, 0.6, 0.25),
      planeOfFan(8, PlaneKind::Symmetry, 0.5, 0.9),  // the third one again
  };
  DetectionOptions options;
  const auto supports = [&] {
    const JudgedShape searched(box(500, Sampling::Random, 3).cloud(), options);
    std::vector<double> found;
    for (const SymmetryPlane& plane : rankedPlanes(searched, planes)) {
      EXPECT_EQ(plane.point_support.size(), 500u);
      found.push_back(plane.support);
    }
    return found;
  };
  EXPECT_EQ(supports(), (std::vector<double>{0.3, 0.25, 0.2, 0.1})) << "equally confident ones by support";
  options.approximate = true;
  EXPECT_EQ(supports(), (std::vector<double>{0.3, 0.25, 0.2, 0.1, 0.8, 0.7}));
  options.max_planes = 2;
  EXPECT_EQ(supports(), (std::vector<double>{0.3, 0.25}));
}

TEST(RankedPlanes, FewPossibleOnes) {
  const JudgedShape searched(box(500, Sampling::Random, 3).cloud());
  std::vector<SymmetryPlane> planes;
  for (int k = 0; k < 6; ++k) planes.push_back(planeOfFan(k, PlaneKind::Possible, 0.3, 0.5));
  const auto numRanked = [&] { return rankedPlanes(searched, planes).size(); };
  EXPECT_EQ(numRanked(), static_cast<std::size_t>(kDetection.decide.max_possible));
  for (SymmetryPlane& plane : planes) plane.kind = PlaneKind::Symmetry;
  EXPECT_EQ(numRanked(), 6u);
}

TEST(RankedPlanes, APlaneOnTheSlopeOfABetterOneIsNoMaximum) {
  const JudgedShape searched(box(500, Sampling::Random, 3).cloud());
  const auto numRanked = [&](double score) {
    std::vector<SymmetryPlane> planes{planeOfFan(0, PlaneKind::Symmetry, 0.9, 0.9)};
    planes.emplace_back(ReflectionPlane({std::cos(0.1), std::sin(0.1), 0.0}, 0.0));
    planes.back().kind = PlaneKind::Symmetry;
    planes.back().confidence = 0.8;
    planes.back().score = score;
    return rankedPlanes(searched, planes).size();
  };
  EXPECT_EQ(numRanked(0.0), 1u) << "D between them is greater";
  EXPECT_EQ(numRanked(1.1), 2u) << "D falls on the way";
}

TEST(BestApproximate, IsThePlaneOfTheGreatestShareWhereNothingIsDecided) {
  const JudgedShape searched(box(500, Sampling::Random, 3).cloud());
  std::vector<SymmetryPlane> planes{planeOfFan(0, PlaneKind::Approximate, 0.1, 0.1),
                                    planeOfFan(1, PlaneKind::Approximate, 0.1, 0.2),
                                    planeOfFan(2, PlaneKind::Local, 0.0, 0.3)};
  for (std::size_t k = 0; k < planes.size(); ++k) planes[k].share = 0.9 + 0.02 * static_cast<double>(k);
  const auto best = [&] { return bestApproximate(searched, planes); };
  ASSERT_TRUE(best());
  EXPECT_EQ(best()->support, 0.2);
  EXPECT_EQ(best()->point_support.size(), 500u);
  planes[1].seen = 0.5;
  EXPECT_EQ(best()->support, 0.1) << "half of it was not seen";
  planes[0].kind = PlaneKind::Possible;
  EXPECT_FALSE(best());
}

TEST(PlaneDecision, SkipsWhatAQuickLookShowsToBeHopeless) {
  const JudgedShape searched(box({1.0, 0.7, 0.4}, 5000, Sampling::Random, 3).cloud());
  const auto isHopeless = [&](double offset, double merit) {
    Candidate candidate;
    candidate.plane = searched.normalized(Eigen::Vector3d::UnitX(), offset);
    candidate.merit = merit;
    return searched.decision.isHopeless(candidate);
  };
  EXPECT_FALSE(isHopeless(0.0, 0.5));
  EXPECT_TRUE(isHopeless(0.3, 0.5));
  EXPECT_FALSE(isHopeless(0.3, 0.95)) << "its merit is that of a symmetry";
}

}  // namespace
