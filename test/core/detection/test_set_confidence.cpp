/// The only writer of confidence and kind, and the rules that lower a plane by what was found beside it.
#include "core/detection/plane_decision.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace {

using namespace pcl_symmetry;

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
