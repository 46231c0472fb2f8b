/// From maxima to planes that are symmetries: how they are refined, measured and decided, and what lowers them.
#include "core/base/random.h"
#include "core/detection/plane_decision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/constants.h"
#include "core/geometry/point_samples.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/searched_shape.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// A box, and what refines its planes.
struct RefinedBox : test::SearchedShape {
  RefinedBox() : SearchedShape(test::box({1.0, 0.7, 0.4}, 5000, test::Sampling::Random, 1).cloud()) {}

  Candidate candidate(const Eigen::Vector3d& normal, double offset) const {
    return {normalized(normal.normalized(), offset)};
  }
};

TEST(PlaneFit, EachStageComesNearer) {
  const RefinedBox box;
  const ReflectionPlane exact = box.normalized(Eigen::Vector3d::UnitX(), 0.0);
  std::vector<Candidate> candidates{box.candidate({1.0, 0.06, -0.04}, 0.03)};
  const double at_start = candidates[0].plane.angleTo(exact);
  candidates = box.fit.refineCoarsely(candidates, PlaneGrid(box.options.expert, box.edt.center(), box.edt.radius()));
  ASSERT_EQ(candidates.size(), 1u);
  EXPECT_LT(candidates[0].plane.angleTo(exact), 0.3 * at_start);
  candidates = box.fit.refineFully(box.fit.refineClosely(candidates));
  ASSERT_EQ(candidates.size(), 1u);
  EXPECT_LT(candidates[0].plane.angleTo(exact), 0.1 * kDegree);
  EXPECT_GT(candidates[0].merit, kDetection.stages.symmetric_merit);
}

TEST(PlaneFit, DistinctKeepsTheBestOfLikePlanes) {
  const RefinedBox box;
  std::vector<Candidate> candidates{box.candidate({1.0, 0.0, 0.0}, 0.0), box.candidate({1.0, 0.01, 0.0}, 0.0),
                                    box.candidate({0.0, 1.0, 0.0}, 0.0)};
  candidates[0].merit = 0.5;
  candidates[1].merit = 0.6;
  candidates[2].merit = 0.55;
  const std::vector<Candidate> kept = box.fit.distinct(candidates);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].merit, 0.6);
  EXPECT_EQ(kept[1].merit, 0.55);
  EXPECT_EQ(box.fit.distinct(candidates, 1).size(), 1u) << "none may be a symmetry";
}

TEST(PlaneMeasure, ShareFallsWithTheDistanceFromASymmetry) {
  const RefinedBox box;
  const auto shareAt = [&](double offset) {
    return box.measure.measurePlane(box.normalized(Eigen::Vector3d::UnitX(), offset), box.measure.samples())
        .evidence.share;
  };
  EXPECT_GT(shareAt(0.0), 0.99);
  double last = 1.0;
  for (const double offset : {0.02, 0.1, 0.3}) {
    const double share = shareAt(offset);
    EXPECT_LT(share, last) << offset;
    last = share;
  }
  EXPECT_LT(last, 0.7) << "a third of the box reaches beyond its other side";
}

TEST(PlaneMeasure, MatchesOfOtherSamplesAreNotTaken) {
  const RefinedBox box;
  const auto drawn = [](std::uint64_t seed) { return drawSamples(5000, 500, seed); };
  Candidate candidate;
  candidate.plane = box.normalized(Eigen::Vector3d::UnitX(), 0.0);
  candidate.samples = std::make_shared<const std::vector<int>>(drawn(1));
  candidate.step = box.fit.matches(candidate.plane, *candidate.samples);
  EXPECT_EQ(box.measure.measureCandidate(candidate, drawn(2)).evidence.share,
            box.measure.measurePlane(candidate.plane, drawn(2)).evidence.share);
}

TEST(CloudLimits, TheOwnPlaneOfASheetMovesNothing) {
  const SearchedShape sheet(test::flatSquare(2000, 1));
  const CloudLimits& limits = sheet.measure.limits();
  EXPECT_EQ(limits.thinness(), Thinness::Sheet);
  const PrincipalAxes& axes = sheet.cloud.principal_axes;
  const auto rulesOf = [&](int k) {
    return limits.rulesAgainst({axes.axes.col(k), axes.axes.col(k).dot(axes.center)}, sheet.cloud.points).size();
  };
  EXPECT_EQ(rulesOf(0), 0u);
  EXPECT_EQ(rulesOf(2), 1u);
}

TEST(CloudLimits, ASensorThatResolvesTooLittle) {
  const Points points = test::box({1.0, 0.7, 0.4}, 500, test::Sampling::Random, 1).cloud();
  const auto numRules = [&](double tolerance, double resolution) {
    const CloudLimits limits(points, principalAxes(points), CloudKind::Scan, nullptr,
                             {tolerance, resolution, 0.05, 1.0});
    return limits.rulesAgainst(ReflectionPlane(Eigen::Vector3d::UnitX(), 0.0), points).size();
  };
  EXPECT_EQ(numRules(0.01, 0.005), 0u);
  EXPECT_EQ(numRules(0.01, 0.02), 1u) << "the tolerance was given";
  EXPECT_EQ(numRules(0.03, 0.08), 0u);
  EXPECT_EQ(numRules(0.03, 0.1), 1u);
}

TEST(PlaneSearch, PointsOfAScanThatStayInPlaceAreUninformative) {
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
  const SearchedShape scan(points, {}, &*seen);
  std::vector<Candidate> candidates(2);
  candidates[0].plane = scan.normalized(Eigen::Vector3d::UnitZ(), 0.0);
  candidates[1].plane = scan.normalized(Eigen::Vector3d::UnitX(), 0.0);
  const std::vector<MeasuredPlane> judged = scan.judge(candidates);
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
    const SearchedShape searched(box(500, Sampling::Random, 3).cloud(), options);
    std::vector<double> found;
    for (const SymmetryPlane& plane : selectReported(searched, planes)) {
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
  const SearchedShape searched(box(500, Sampling::Random, 3).cloud());
  std::vector<SymmetryPlane> planes;
  for (int k = 0; k < 6; ++k) planes.push_back(planeOfFan(k, PlaneKind::Possible, 0.3, 0.5));
  const auto numRanked = [&] { return selectReported(searched, planes).size(); };
  EXPECT_EQ(numRanked(), static_cast<std::size_t>(kDetection.decide.max_possible));
  for (SymmetryPlane& plane : planes) plane.kind = PlaneKind::Symmetry;
  EXPECT_EQ(numRanked(), 6u);
}

TEST(RankedPlanes, APlaneOnTheSlopeOfABetterOneIsNoMaximum) {
  const SearchedShape searched(box(500, Sampling::Random, 3).cloud());
  const auto numRanked = [&](double score) {
    std::vector<SymmetryPlane> planes{planeOfFan(0, PlaneKind::Symmetry, 0.9, 0.9)};
    planes.emplace_back(ReflectionPlane({std::cos(0.1), std::sin(0.1), 0.0}, 0.0));
    planes.back().kind = PlaneKind::Symmetry;
    planes.back().confidence = 0.8;
    planes.back().score = score;
    return selectReported(searched, planes).size();
  };
  EXPECT_EQ(numRanked(0.0), 1u) << "D between them is greater";
  EXPECT_EQ(numRanked(1.1), 2u) << "D falls on the way";
}

TEST(BestApproximate, IsThePlaneOfTheGreatestShareWhereNothingIsDecided) {
  const SearchedShape searched(box(500, Sampling::Random, 3).cloud());
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

TEST(PlaneSearch, SkipsWhatAQuickLookShowsToBeHopeless) {
  const SearchedShape searched(box({1.0, 0.7, 0.4}, 5000, Sampling::Random, 3).cloud());
  const auto isHopeless = [&](double offset, double merit) {
    Candidate candidate;
    candidate.plane = searched.normalized(Eigen::Vector3d::UnitX(), offset);
    candidate.merit = merit;
    return searched.isHopeless(candidate);
  };
  EXPECT_FALSE(isHopeless(0.0, 0.5));
  EXPECT_TRUE(isHopeless(0.3, 0.5));
  EXPECT_FALSE(isHopeless(0.3, 0.95)) << "its merit is that of a symmetry";
}

const DetectionOptions kOptions;

SymmetryPlane planeOf(double confidence, double seen = 1.0, double score = 0.9,
                      const Eigen::Vector3d& normal = Eigen::Vector3d::UnitX()) {
  SymmetryPlane plane(ReflectionPlane(normal, 0.0));
  plane.seen = seen;
  plane.score = score;
  setConfidence(plane, confidence, "evidence", kOptions);
  return plane;
}

double oddsOf(double p) {
  return p / (1.0 - p);
}

TEST(SetConfidence, KindFollowsAndReasonsMultiplyToTheOdds) {
  EXPECT_EQ(planeOf(0.5).kind, PlaneKind::Symmetry);
  EXPECT_EQ(planeOf(0.2).kind, PlaneKind::Possible);
  EXPECT_EQ(planeOf(0.19).kind, PlaneKind::Approximate);
  SymmetryPlane plane = planeOf(0.8);
  multiplyOdds(plane, 0.1, "slants", kOptions);
  EXPECT_NEAR(oddsOf(plane.confidence), 0.4, 1e-12);
  EXPECT_EQ(plane.kind, PlaneKind::Possible);
  changeConfidence(plane, 0.7, "polygon", kOptions);
  multiplyOdds(plane, 1.0, "uninformative", kOptions);
  ASSERT_EQ(plane.reasons.size(), 3u);
  EXPECT_STREQ(plane.reasons[1].rule, "slants");
  double product = 1.0;
  for (const Reason& reason : plane.reasons) product *= *reason.odds;
  EXPECT_NEAR(product, oddsOf(0.7), 1e-9);
}

TEST(SetConfidence, CertaintyHasFiniteOdds) {
  for (const double confidence : {0.0, 1.0}) {
    const SymmetryPlane plane = planeOf(confidence);
    EXPECT_EQ(plane.confidence, confidence);
    EXPECT_TRUE(*plane.reasons[0].odds > 0.0 && *plane.reasons[0].odds < std::numeric_limits<double>::infinity());
  }
}

TEST(SetConfidence, NoEvidenceLiftsALimit) {
  SymmetryPlane plane = planeOf(0.9);
  limitToPossible(plane, "the plane moves nothing");
  EXPECT_EQ(plane.kind, PlaneKind::Possible);
  setConfidence(plane, 0.999, "mesh", kOptions);
  EXPECT_EQ(plane.kind, PlaneKind::Possible);
  EXPECT_EQ(plane.confidence, 0.999);
  ASSERT_EQ(plane.reasons.size(), 2u) << "the evidence replaced that of before";
  EXPECT_FALSE(plane.reasons[0].odds);
  setConfidence(plane, 0.1, "mesh", kOptions);
  EXPECT_EQ(plane.kind, PlaneKind::Approximate);
}

TEST(DoubtMissingPieces, WhereAnotherPlaneExplainsAll) {
  const auto doubted = [](double seen_of_best, CloudKind kind) {
    std::vector<SymmetryPlane> planes{planeOf(0.9, seen_of_best), planeOf(0.9, 0.9), planeOf(0.9, 0.98)};
    doubtMissingPieces(planes, kind, kOptions);
    EXPECT_EQ(planes[0].confidence, 0.9);
    EXPECT_EQ(planes[2].confidence, 0.9) << "so little is missing by chance";
    return oddsOf(planes[1].confidence);
  };
  EXPECT_NEAR(doubted(1.0, CloudKind::Surface), 0.2 * 9.0, 1e-9);
  EXPECT_NEAR(doubted(0.98, CloudKind::Surface), 9.0, 1e-9) << "no plane explains all";
  EXPECT_NEAR(doubted(1.0, CloudKind::Scan), 9.0, 1e-9) << "a scan shows one side";
}

TEST(DoubtFurtherPlanes, AllButTheBestOfAScan) {
  const auto doubted = [](bool has_family, CloudKind kind) {
    // The second is as likely as the first, and has the greater D.
    std::vector<SymmetryPlane> planes{planeOf(0.9, 0.6, 0.7), planeOf(0.88, 0.6, 0.8), planeOf(0.7, 0.6, 0.9)};
    doubtFurtherPlanes(planes, has_family, kind, kOptions);
    std::vector<bool> is_doubted;
    for (const SymmetryPlane& plane : planes) {
      is_doubted.push_back(plane.reasons.size() == 2u);
      if (!is_doubted.back()) continue;
      EXPECT_STREQ(plane.reasons[1].rule, has_family ? "there is an axis or a center, which explains more than a plane"
                                                     : "another plane is likelier, or as likely with a greater score");
    }
    return is_doubted;
  };
  EXPECT_EQ(doubted(false, CloudKind::Scan), (std::vector<bool>{true, false, true}));
  EXPECT_EQ(doubted(true, CloudKind::Scan), (std::vector<bool>{true, true, true}));
  EXPECT_EQ(doubted(true, CloudKind::Volume), (std::vector<bool>{false, false, false}));
}

TEST(DoubtSlantedPlanes, OfWhatStandsOnASupport) {
  const std::vector<Eigen::Vector3d> up{Eigen::Vector3d::UnitZ()};
  std::vector<SymmetryPlane> planes{planeOf(0.9), planeOf(0.9, 1.0, 0.9, {1.0, 0.0, 1.0}),
                                    planeOf(0.1, 1.0, 0.9, {1.0, 0.0, 1.0})};
  doubtSlantedPlanes(planes, {}, kOptions);
  EXPECT_EQ(planes[1].confidence, 0.9) << "nothing carries it";
  doubtSlantedPlanes(planes, up, kOptions);
  EXPECT_EQ(planes[0].confidence, 0.9);
  EXPECT_NEAR(oddsOf(planes[1].confidence), 0.1 * 9.0, 1e-9);
  EXPECT_EQ(planes[2].confidence, 0.1) << "is no symmetry anyway";
}

}  // namespace
