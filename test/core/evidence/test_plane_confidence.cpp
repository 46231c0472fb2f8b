/// Evidence for a plane: support, stiffness, and the confidence that follows.
#include "core/evidence/plane_confidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/evidence/surface_samples.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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

TEST(PlaneConfidence, OfAFlatCloudCountsMoreOfTheOutlineAsOff) {
  PlaneEvidence evidence = evidenceOf(0.98, 0.02, 0.05, CloudKind::Surface), exact = evidence;
  evidence.share = 0.98;
  const double solid = planeConfidence(evidence), exact_solid = planeConfidence(exact);
  evidence.flat = exact.flat = true;
  EXPECT_LT(planeConfidence(evidence), solid - 0.1);
  EXPECT_GT(planeConfidence(exact), exact_solid - 0.05);
}

TEST(PlaneConfidence, FallsAsEvidenceGetsWorse) {
  expectFalls("share", [](PlaneEvidence& e, double t) { e.share = 1.0 - t; });
  expectFalls("share within twice the tolerance", [](PlaneEvidence& e, double t) { e.double_share = 1.0 - t; });
  expectFalls("hold", [](PlaneEvidence& e, double t) { e.stiffness = 0.1 * (1.0 - t); });
  expectFalls("unknown", [](PlaneEvidence& e, double t) {
    e.unknown = t;
    // What is hidden or missing has its part in D: where D is the same although more is, what is seen agrees better.
    if (e.kind != CloudKind::Volume) e.score -= kEvidenceUnits.hidden_loss * t;
  });
  expectFalls("score", [](PlaneEvidence& e, double t) { e.score = 1.0 - t; });
  expectFalls("support", [](PlaneEvidence& e, double t) { e.support = 1.0 - t; });
  expectFalls("noise", [](PlaneEvidence& e, double t) {
    e.score = std::max(0.0, e.score - 0.5 * t);
    if (e.kind == CloudKind::Volume) e.own_score -= 0.4 * t;
  });
}

TEST(FurtherOdds, AreLessWhereSomethingIsHidden) {
  for (const CloudKind kind : {CloudKind::Surface, CloudKind::Scan, CloudKind::Volume}) {
    for (const double unknown : {0.0, 0.2}) {
      const bool hidden = kind == CloudKind::Scan || (kind == CloudKind::Surface && unknown > 0.0);
      EXPECT_EQ(furtherOdds(kind, unknown) < 1.0, hidden) << static_cast<int>(kind) << ", " << unknown;
      EXPECT_LE(furtherOdds(kind, unknown), 1.0) << static_cast<int>(kind) << ", " << unknown;
    }
  }
}

TEST(PlaneConfidence, IsKnownAtAnyTolerance) {
  for (const auto& [name, good] : regimes()) {
    PlaneEvidence evidence = good;
    evidence.share = evidence.double_share = 1.0;
    evidence.tolerance = 1e-9;  // of exactly symmetric points, far below their spacing
    EXPECT_TRUE(planeConfidence(evidence) >= 0.0) << name;
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
                ASSERT_TRUE(confidence >= 0.0 && confidence <= 1.0) << confidence << ": " << support << " " << share;
                ASSERT_TRUE(0.0 <= interval.low && interval.low <= share) << interval.low;
                ASSERT_TRUE(share <= interval.high && interval.high <= 1.0) << interval.high;
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

struct Samples {
  Points points, normals;
};

constexpr int kSamples = 2000;
const ReflectionPlane kAcrossX(Eigen::Vector3d::UnitX(), 0.0);

Samples ball() {
  const Points points = sphere(kSamples, 1).cloud();
  return {points, points};
}

/// About z, without its ends.
Samples tube() {
  Samples samples = ball();
  RandomStream random(2);
  for (int i = 0; i < kSamples; ++i) {
    samples.normals(2, i) = 0.0f;
    samples.normals.col(i).normalize();
    samples.points.col(i) = 0.5f * samples.normals.col(i);
    samples.points(2, i) = static_cast<float>(random.uniform()) - 0.5f;
  }
  return samples;
}

/// Edges of 0.8, 0.6 and 1.
Samples box() {
  Samples samples{Points(3, kSamples), Points(3, kSamples)};
  const Eigen::Vector3f half(0.4f, 0.3f, 0.5f);
  RandomStream random(3);
  for (int i = 0; i < kSamples; ++i) {
    for (int k = 0; k < 3; ++k) samples.points(k, i) = half[k] * (2.0f * static_cast<float>(random.uniform()) - 1.0f);
    const float side = i % 2 == 0 ? 1.0f : -1.0f;
    samples.points(i % 3, i) = side * half[i % 3];
    samples.normals.col(i) = side * Eigen::Vector3f::Unit(i % 3);
  }
  return samples;
}

Eigen::Matrix3d stiffnessOf(const Samples& samples, const ReflectionPlane& plane) {
  return motionStiffness(samples.points, samples.normals, std::vector<char>(kSamples, 1), plane);
}

TEST(PlaneStiffness, ABallHoldsNothingButTheOffset) {
  const Eigen::Matrix3d stiffness = stiffnessOf(ball(), kAcrossX);
  EXPECT_NEAR(secondStiffness(stiffness), 0.0, 1e-6);
  EXPECT_NEAR(offsetStiffness(stiffness), 4.0 / 3.0, 0.1) << "mean square of 2 n.x over a ball";
}

TEST(PlaneStiffness, ATubeHoldsPlanesThroughItsAxisButNotThePlaneAcross) {
  const Eigen::Matrix3d stiffness = stiffnessOf(tube(), kAcrossX);
  EXPECT_GT(secondStiffness(stiffness), 0.05);
  EXPECT_GT(offsetStiffness(stiffness), 1.0);
  EXPECT_NEAR(offsetStiffness(stiffnessOf(tube(), {Eigen::Vector3d::UnitZ(), 0.0})), 0.0, 1e-9) << "it has no ends";
}

TEST(PlaneStiffness, ABoxHoldsItsPlanes) {
  for (int k = 0; k < 3; ++k) {
    const Eigen::Matrix3d stiffness = stiffnessOf(box(), {Eigen::Vector3d::Unit(k), 0.0});
    EXPECT_GT(secondStiffness(stiffness), 0.02) << k;
    EXPECT_GT(offsetStiffness(stiffness), 0.5) << k;
  }
}

TEST(PlaneStiffness, WhereNothingMatchesNothingHolds) {
  const Samples samples = box();
  const Eigen::Matrix3d stiffness =
      motionStiffness(samples.points, samples.normals, std::vector<char>(kSamples, 0), kAcrossX);
  EXPECT_EQ(stiffness, Eigen::Matrix3d::Zero());
  EXPECT_EQ(secondStiffness(stiffness), 0.0);
  EXPECT_EQ(offsetStiffness(stiffness), 0.0);
}

TEST(PlaneSupport, IsOneOnTheSurfaceAndFallsOffIt) {
  // A square lattice of spacing 0.1: along the surface the support is 1 up to 1.25 spacings from the nearest sample,
  // across it up to 0.01 of the radius; beyond both it falls as a Gaussian of the excess.
  Points lattice(3, 41 * 41);
  for (int i = 0; i < 41 * 41; ++i) lattice.col(i) << 0.1f * (i % 41 - 20), 0.1f * (i / 41 - 20), 0.0f;
  const double radius = boundingBall(lattice).radius;
  const auto supportAt = [&](double x, double z) {
    const Points point = Eigen::Vector3d(x, 0.03, z).cast<float>();
    return planeSupport(point, lattice, {kAcrossX}, nullptr, 1)[0][0];
  };
  EXPECT_EQ(supportAt(0.97, 0.0), 1.0f);
  EXPECT_EQ(supportAt(0.97, 0.009 * radius), 1.0f);
  EXPECT_NEAR(supportAt(0.97, 0.02 * radius), std::exp(-1.0f), 1e-3f);
  EXPECT_EQ(supportAt(2.1, 0.0), 1.0f);
  EXPECT_GT(supportAt(2.2, 0.0), supportAt(2.3, 0.0));
  EXPECT_LT(supportAt(3.0, 0.0), 1e-3f);
}

TEST(PlaneSupport, OfASymmetryIsThatOfASecondSample) {
  // 1 in 130 lies beyond the reach along the surface, where the second sample is independent.
  const Shape shape = box(6000, Sampling::Random, 8);
  const Points points = shape.cloud();
  const auto supports = planeSupport(points, points, shape.planes, nullptr, 1);
  ASSERT_EQ(supports.size(), shape.planes.size());
  for (const std::vector<float>& support : supports) EXPECT_GT(meanOf(support), 1.0 - 1.0 / 130.0);
  EXPECT_EQ(planeSupport(points, points, shape.planes, nullptr, 8), supports);
  EXPECT_EQ(planeSupport(points, points, {shape.planes[1]}, nullptr, 1)[0], supports[1]) << "as one by one";
  const std::vector<float> wrong = planeSupport(points, points, {ReflectionPlane({1.0, 1.0, 0.0}, 0.0)}, nullptr, 1)[0];
  EXPECT_LT(meanOf(wrong), 0.7);
}

}  // namespace
