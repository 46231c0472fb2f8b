/// Confidence: better evidence never makes a plane less likely, and the limits are finite.
#include "core/evidence/plane_confidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace {

using namespace pcl_symmetry;

struct Regime {
  std::string name;
  PlaneEvidence good;  ///< of a symmetry that is well sampled
};

PlaneEvidence evidenceOf(double score, double spacing, double roughness, CloudKind kind) {
  PlaneEvidence evidence;
  evidence.support = 0.99;
  evidence.conflict = 0.01;
  evidence.score = score;
  evidence.spacing = spacing;
  evidence.roughness = roughness;
  evidence.kind = kind;
  evidence.share = 0.999;
  if (kind == CloudKind::Volume) evidence.own_score = 0.985;
  return evidence;
}

std::vector<Regime> regimes() {
  return {{"whole", evidenceOf(0.98, 0.02, 0.05, CloudKind::Surface)},
          {"sparse", evidenceOf(0.97, 0.05, 0.20, CloudKind::Surface)},
          {"volume", evidenceOf(0.98, 0.02, 0.40, CloudKind::Volume)},
          {"scan", evidenceOf(0.95, 0.02, 0.05, CloudKind::Scan)}};
}

/// Confidence must not rise while a value goes from good to bad in 40 steps.
void expectFalls(const std::string& what, const std::function<void(PlaneEvidence&, double)>& worsen) {
  for (const auto& [name, good] : regimes()) {
    double before = 1.0;
    for (int step = 0; step <= 40; ++step) {
      PlaneEvidence evidence = good;
      worsen(evidence, step / 40.0);
      const double confidence = planeConfidence(evidence);
      EXPECT_LE(confidence, before + 1e-12) << name << ", " << what << ", step " << step;
      before = confidence;
    }
  }
}

TEST(PlaneConfidence, FallsAsEvidenceGetsWorse) {
  expectFalls("share", [](PlaneEvidence& e, double t) { e.share = 1.0 - t; });
  expectFalls("share within twice the tolerance", [](PlaneEvidence& e, double t) { e.double_share = 1.0 - t; });
  expectFalls("hold", [](PlaneEvidence& e, double t) { e.hold = 0.1 * (1.0 - t); });
  expectFalls("unknown", [](PlaneEvidence& e, double t) {
    e.unknown = t;
    // What is hidden or missing has its part in D: where D is the same although more is, what is seen agrees better.
    if (e.kind != CloudKind::Volume) e.score -= EvidenceUnits().hidden_loss * t;
  });
  expectFalls("score", [](PlaneEvidence& e, double t) { e.score = 1.0 - t; });
  expectFalls("support", [](PlaneEvidence& e, double t) { e.support = 1.0 - t; });
  expectFalls("further", [](PlaneEvidence& e, double t) { e.further = t > 0.5; });
  expectFalls("noise", [](PlaneEvidence& e, double t) {
    e.score = std::max(0.0, e.score - 0.5 * t);
    if (e.kind == CloudKind::Volume) e.own_score -= 0.4 * t;
  });
}

TEST(PlaneConfidence, OfFurtherPlanesIsLessWhereSomethingIsHidden) {
  for (const auto& [name, good] : regimes()) {
    for (const double unknown : {0.0, 0.2}) {
      PlaneEvidence evidence = good;
      evidence.unknown = unknown;
      const double alone = planeConfidence(evidence);
      evidence.further = true;
      const double further = planeConfidence(evidence);
      const bool hidden = evidence.kind == CloudKind::Scan || (evidence.kind == CloudKind::Surface && unknown > 0.0);
      EXPECT_EQ(further < alone, hidden) << name << ", " << unknown;
      EXPECT_LE(further, alone) << name << ", " << unknown;
      EXPECT_NEAR(furtherConfidence(alone, evidence.kind, unknown), further, 1e-12) << name << ", " << unknown;
    }
    EXPECT_EQ(furtherConfidence(0.0, good.kind, 0.5), 0.0);
    EXPECT_EQ(furtherConfidence(1.0, good.kind, 0.5), 1.0);
  }
}

TEST(PlaneConfidence, IsHighForSymmetriesAndLowForOthers) {
  for (const auto& [name, good] : regimes()) {
    EXPECT_GT(planeConfidence(good), 0.5) << name;
    PlaneEvidence half = good;
    half.share = 0.5;
    half.double_share = half.support = half.score = 0.6;
    EXPECT_LT(planeConfidence(half), 0.05) << name;
  }
}

TEST(PlaneConfidence, OfAWholeCloudFollowsTheDefinition) {
  // 97 % of the surface make a symmetry; below 90 % a plane is none.
  PlaneEvidence evidence = regimes().front().good;
  evidence.share = 0.985;
  evidence.double_share = 0.99;
  EXPECT_GT(planeConfidence(evidence), 0.5);
  evidence.share = 0.90;
  evidence.double_share = 0.94;
  EXPECT_LT(planeConfidence(evidence), 0.5);
}

TEST(PlaneConfidence, WhatIsOffByCoarserPointsIsMoreOfTheSurface) {
  PlaneEvidence fine = evidenceOf(0.98, 0.01, 0.05, CloudKind::Surface), coarse = fine;
  fine.share = fine.double_share = coarse.share = coarse.double_share = 0.97;
  coarse.spacing = 0.04;
  EXPECT_LT(planeConfidence(coarse), planeConfidence(fine));
  EXPECT_GT(logOddsTerms(coarse)[1], logOddsTerms(fine)[1]);
}

TEST(PlaneConfidence, IsAProbabilityEverywhere) {
  for (const double support : {0.0, 1e-9, 0.5, 1.0, 1.1})
    for (const double share : {0.0, 1e-9, 0.5, 1.0})
      for (const double score : {0.0, 0.5, 1.0})
        for (const double unknown : {0.0, 0.5, 1.0})
          for (const double spacing : {0.0, 1e-6, 0.1, 1.0})
            for (const double roughness : {0.0, 0.3, 10.0})
              for (const int kind : {0, 1, 2}) {
                PlaneEvidence evidence = evidenceOf(score, spacing, roughness, static_cast<CloudKind>(kind));
                evidence.support = support;
                evidence.share = share;
                evidence.unknown = unknown;
                const double confidence = planeConfidence(evidence);
                const ShareInterval interval = shareInterval(evidence);
                ASSERT_TRUE(std::isfinite(confidence)) << support << " " << share;
                ASSERT_GE(confidence, 0.0);
                ASSERT_LE(confidence, 1.0);
                ASSERT_GE(interval.low, 0.0);
                ASSERT_LE(interval.low, share);
                ASSERT_GE(interval.high, share);
                ASSERT_LE(interval.high, 1.0);
              }
}

TEST(PlaneConfidence, FewerPointsAndNoiseWidenTheInterval) {
  PlaneEvidence evidence = regimes().front().good;
  evidence.share = 0.9;
  const ShareInterval fine = shareInterval(evidence);
  evidence.spacing *= 3.0;
  const ShareInterval coarse = shareInterval(evidence);
  evidence.roughness = 0.3;
  const ShareInterval rough = shareInterval(evidence);
  EXPECT_GT(coarse.high - coarse.low, fine.high - fine.low);
  EXPECT_GT(rough.high - rough.low, coarse.high - coarse.low);
}

TEST(PlaneConfidence, SupportIsCountedInWhatSamplingLets) {
  PlaneEvidence evidence;
  evidence.support = 0.45;
  evidence.conflict = 0.05;
  evidence.baseline = 0.9;
  EXPECT_NEAR(seenSupport(evidence), 1.0, 1e-12);  // 0.45 / (0.5 * 0.9)
  evidence.baseline = 1.0;
  EXPECT_NEAR(seenSupport(evidence), 0.9, 1e-12);
  evidence.support = 0.5;
  evidence.conflict = 0.0;
  evidence.baseline = 0.8;
  EXPECT_EQ(seenSupport(evidence), 1.0) << "never more than everything";
}

}  // namespace
