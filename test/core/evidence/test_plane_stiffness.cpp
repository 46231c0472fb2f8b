/// Which points support a plane, and which of its motions the matched surface excludes.
#include "core/evidence/plane_stiffness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "core/evidence/plane_support.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

struct Samples {
  Points points, normals;
};

constexpr int kSamples = 2000;
const ReflectionPlane kAcrossX(Eigen::Vector3d::UnitX(), 0.0);

Samples ball() {
  Samples samples{Points(3, kSamples), Points(3, kSamples)};
  RandomStream random(1);
  for (int i = 0; i < kSamples; ++i) {
    const double z = 2.0 * random.uniform() - 1.0, angle = 2.0 * kPi * random.uniform(), ring = std::sqrt(1.0 - z * z);
    samples.normals.col(i) = Eigen::Vector3d(ring * std::cos(angle), ring * std::sin(angle), z).cast<float>();
    samples.points.col(i) = samples.normals.col(i);
  }
  return samples;
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

TEST(PlaneStiffness, ATubeHoldsPlanesThroughItsAxisButForTurnsAboutIt) {
  const Eigen::Matrix3d stiffness = stiffnessOf(tube(), kAcrossX);
  EXPECT_GT(secondStiffness(stiffness), 0.05);
  EXPECT_GT(offsetStiffness(stiffness), 1.0);
}

TEST(PlaneStiffness, ATubeWithoutEndsDoesNotHoldThePlaneAcross) {
  EXPECT_NEAR(offsetStiffness(stiffnessOf(tube(), {Eigen::Vector3d::UnitZ(), 0.0})), 0.0, 1e-9);
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
  const ReflectionPlane plane(Eigen::Vector3d::UnitX(), 0.0);
  const auto supportAt = [&](double x, double z) {
    const Points point = Eigen::Vector3d(x, 0.03, z).cast<float>();
    return planeSupport(point, lattice, plane, 1)[0];
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
  for (const ReflectionPlane& plane : shape.planes) {
    const std::vector<float> support = planeSupport(points, points, plane, 1);
    const double mean = std::accumulate(support.begin(), support.end(), 0.0) / static_cast<double>(support.size());
    EXPECT_GT(mean, 1.0 - 1.0 / 130.0);
    EXPECT_EQ(planeSupport(points, points, plane, 8), support);
  }
  const std::vector<float> wrong = planeSupport(points, points, ReflectionPlane({1.0, 1.0, 0.0}, 0.0), 1);
  EXPECT_LT(std::accumulate(wrong.begin(), wrong.end(), 0.0) / static_cast<double>(wrong.size()), 0.7);
}

}  // namespace
