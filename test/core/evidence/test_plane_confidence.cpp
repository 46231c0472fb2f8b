/// Confidence: better evidence never makes a plane less likely, and the limits are finite.
#include "core/evidence/plane_confidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace pcl_symmetry;

struct Regime {
  std::string name;
  PlaneEvidence good;  ///< of a symmetry that is well sampled
};

std::vector<Regime> regimes() {
  return {{"whole", {0.97, 0.02, 0.98, 0.98, 0.02, 0.05, false, false}},
          {"rough", {0.90, 0.10, 0.95, 0.92, 0.05, 0.30, false, false}},
          {"volume", {0.98, 0.02, 0.98, 1.0, 0.05, 0.40, false, true}},
          {"scan", {0.30, 0.01, 0.40, 0.98, 0.02, 0.05, true, false}}};
}

TEST(PlaneConfidence, FallsWithConflict) {
  for (const auto& [name, good] : regimes()) {
    double before = 1.0;
    for (int step = 0; step <= 40; ++step) {
      PlaneEvidence evidence = good;
      const double moved = good.support * step / 40.0;  // from support to conflict: the points seen stay
      evidence.conflict = good.conflict + moved;
      if (!good.partial) evidence.support -= moved;
      const double confidence = planeConfidence(evidence);
      EXPECT_LE(confidence, before + 1e-12) << name << ", conflict " << evidence.conflict;
      before = confidence;
    }
    EXPECT_LT(before, 0.05) << name << ": as much conflict as support, or nothing but conflict";
  }
}

TEST(PlaneConfidence, RisesWithSupportOfWhatWasSeen) {
  for (const auto& [name, good] : regimes()) {
    const double seen = good.support + good.conflict;
    double before = 0.0;
    for (int step = 0; step <= 40; ++step) {
      PlaneEvidence evidence = good;
      evidence.support = seen * step / 40.0;
      evidence.conflict = seen - evidence.support;
      const double confidence = planeConfidence(evidence);
      EXPECT_GE(confidence, before - 1e-12) << name << ", support " << evidence.support << " of " << seen;
      before = confidence;
    }
    EXPECT_GT(before, 0.5) << name;
  }
}

TEST(PlaneConfidence, RisesWithScore) {
  for (const auto& [name, good] : regimes()) {
    double before = 0.0;
    for (int step = 0; step <= 40; ++step) {
      PlaneEvidence evidence = good;
      evidence.score = step / 40.0;
      const double confidence = planeConfidence(evidence);
      EXPECT_GE(confidence, before) << name << ", score " << evidence.score;
      before = confidence;
    }
    EXPECT_GT(before, 0.5) << name;
  }
}

TEST(PlaneConfidence, IsAProbabilityEverywhere) {
  for (const double support : {0.0, 1e-9, 0.5, 1.0, 1.1})
    for (const double conflict : {0.0, 1e-9, 0.5, 1.0})
      for (const double score : {0.0, 0.5, 1.0})
        for (const double baseline : {1e-3, 0.5, 1.0})
          for (const double spacing : {0.0, 1e-6, 0.1, 1.0})
            for (const double roughness : {0.0, 0.3, 10.0})
              for (const int kind : {0, 1, 2}) {
                const PlaneEvidence evidence{support, conflict,  score,     baseline,
                                             spacing, roughness, kind == 1, kind == 2};
                const double share = seenSupport(evidence), confidence = planeConfidence(evidence);
                ASSERT_TRUE(std::isfinite(confidence) && std::isfinite(share)) << support << " " << conflict;
                ASSERT_GE(share, 0.0);
                ASSERT_LE(share, 1.0);
                ASSERT_GE(confidence, 0.0);
                ASSERT_LE(confidence, 1.0);
              }
}

TEST(PlaneConfidence, APlaneThatNothingSpeaksForIsNoSymmetry) {
  for (const auto& [name, good] : regimes()) {
    PlaneEvidence evidence = good;
    evidence.support = evidence.score = 0.0;
    evidence.conflict = good.partial ? 0.0 : 1.0;  // of a scan: every reflection falls where nobody looked
    EXPECT_EQ(seenSupport(evidence), 0.0) << name;
    EXPECT_LT(planeConfidence(evidence), 0.02) << name;
    // A hundredth of the points that meet something by chance makes it no better.
    evidence.support = 0.01;
    if (!good.partial) evidence.conflict = 0.99;
    EXPECT_LT(planeConfidence(evidence), 0.5) << name;
  }
}

TEST(PlaneConfidence, SupportIsCountedInWhatSamplingLets) {
  PlaneEvidence evidence{0.45, 0.05, 0.9, 0.9, 0.02, 0.05, true, false};
  EXPECT_NEAR(seenSupport(evidence), 1.0, 1e-12);  // 0.45 / (0.5 * 0.9)
  evidence.baseline = 1.0;
  EXPECT_NEAR(seenSupport(evidence), 0.9, 1e-12);
  evidence.support = 0.5;
  evidence.conflict = 0.0;
  evidence.baseline = 0.8;
  EXPECT_EQ(seenSupport(evidence), 1.0) << "never more than everything";
}

}  // namespace
