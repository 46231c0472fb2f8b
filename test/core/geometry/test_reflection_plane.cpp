#include "pcl_symmetry/core/reflection_plane.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

constexpr double kRounding = 1e-14;  // a few dozen operations of 1.1e-16 each, on numbers up to ten

TEST(ReflectionPlane, AllFormsAreTheSameReflection) {
  RandomStream random(1);
  for (int i = 0; i < 100; ++i) {
    const ReflectionPlane plane(randomDirection(random), 2.0 * symmetric(random));
    const Eigen::Vector3d x = 3.0 * randomPoint(random), reflected = plane.reflect(x);
    EXPECT_LT((plane.reflect(reflected) - x).norm(), 10.0 * kRounding) << "twice is the identity";
    EXPECT_NEAR(plane.signedDistance(reflected), -plane.signedDistance(x), 10.0 * kRounding);
    EXPECT_NEAR(plane.coefficients().dot(x.homogeneous()), plane.signedDistance(x), kRounding);
    EXPECT_LT((plane.reflection() * x - reflected).norm(), 10.0 * kRounding);
    EXPECT_NEAR(plane.reflection().linear().determinant(), -1.0, kRounding);
    const ReflectionPlane a = plane.canonical();
    const ReflectionPlane b = ReflectionPlane(-plane.normal(), -plane.offset()).canonical();
    EXPECT_GE(a.normal().z(), 0.0);
    EXPECT_LT((a.normal() - b.normal()).norm(), kRounding);  // the normal was normalized once more
    EXPECT_NEAR(a.offset(), b.offset(), kRounding);
    EXPECT_LT((a.reflect(x) - reflected).norm(), 10.0 * kRounding);
    const Eigen::Isometry3d motion = randomPose(i);
    EXPECT_LT((plane.transformed(motion).reflect(motion * x) - motion * reflected).norm(), 10.0 * kRounding);
    const Eigen::Vector3d y = 3.0 * randomPoint(random);
    EXPECT_LT((plane.normalized(y, 2.0).reflect((x - y) / 2.0) - (reflected - y) / 2.0).norm(), 10.0 * kRounding);
    EXPECT_LT((ReflectionPlane::between(x, y).reflect(x) - y).norm(), 10.0 * kRounding);
  }
  EXPECT_THROW(ReflectionPlane::between(Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones()), std::invalid_argument);
}

TEST(ReflectionPlane, HasTheSameBitsAtEveryAddress) {
  RandomStream random(2);
  struct alignas(16) {
    Eigen::Vector3d first, second;  // of 24 bytes each: one address is a multiple of 16, the other is not
  } at;
  for (int i = 0; i < 1000; ++i) {
    at.first = at.second = 3.0 * randomPoint(random);
    EXPECT_EQ(ReflectionPlane(at.first, 1.0).coefficients(), ReflectionPlane(at.second, 1.0).coefficients());
  }
}

TEST(ReflectionPlane, ReflectsAsWritten) {
  // x - 2 (n.x - r) n for n = (0, 0, 1), r = 2 turns (1, 2, 5) into (1, 2, -1).
  EXPECT_EQ(ReflectionPlane(Eigen::Vector3d::UnitZ(), 2.0).reflect({1.0, 2.0, 5.0}), Eigen::Vector3d(1.0, 2.0, -1.0));
  EXPECT_EQ(ReflectionPlane().reflect({1.0, 2.0, 5.0}), Eigen::Vector3d(1.0, 2.0, -5.0));
}

TEST(ReflectionPlane, NormalizesNormalAndOffsetTogether) {
  const ReflectionPlane plane(Eigen::Vector3d(0.0, 3.0, 4.0), 10.0);
  EXPECT_TRUE(plane.normal().isApprox(Eigen::Vector3d(0.0, 0.6, 0.8), kRounding));
  EXPECT_NEAR(plane.offset(), 2.0, kRounding);
}

TEST(ReflectionPlane, NormalsOfAnyLengthAreTaken) {
  for (const double length : {1e-300, 1e-160, 1e160, 1e300}) {
    const ReflectionPlane plane(length * Eigen::Vector3d(1.0, 2.0, 2.0), 0.0);
    EXPECT_TRUE(plane.normal().isApprox(Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0, kRounding)) << length;
  }
}

TEST(ReflectionPlane, CanonicalFormOnTheEquator) {
  using Eigen::Vector3d;
  const auto canonical = [](const Vector3d& n) { return ReflectionPlane(n, 0.5).canonical(); };
  EXPECT_EQ(canonical({0.0, -1.0, 0.0}).normal(), Vector3d(0.0, 1.0, 0.0));
  EXPECT_EQ(canonical({0.0, -1.0, 0.0}).offset(), -0.5);
  EXPECT_EQ(canonical({-1.0, 0.0, 0.0}).normal(), Vector3d(1.0, 0.0, 0.0));
  EXPECT_EQ(canonical({1.0, 0.0, 0.0}).offset(), 0.5);
  EXPECT_EQ(canonical({0.6, -0.8, 0.0}).normal(), Vector3d(-0.6, 0.8, 0.0));
  EXPECT_EQ(canonical({0.6, 0.0, -0.8}).normal(), Vector3d(-0.6, 0.0, 0.8));
}

TEST(ReflectionPlane, AngleIsThatOfLines) {
  const ReflectionPlane plane(Eigen::Vector3d::UnitX(), 0.0);
  for (const double angle : {0.0, 1e-9, 1e-4, 0.3, 1.0, 0.5 * kPi}) {
    const Eigen::Vector3d turned(std::cos(angle), std::sin(angle), 0.0);
    EXPECT_NEAR(plane.angleTo(ReflectionPlane(turned, 3.0)), angle, 1e-15) << angle;
    EXPECT_NEAR(plane.angleTo(ReflectionPlane(-turned, 3.0)), angle, 1e-15) << angle;
  }
  EXPECT_NEAR(plane.angleTo(ReflectionPlane({-0.5, std::sqrt(0.75), 0.0}, 0.0)), kPi / 3.0, 1e-15);
}

TEST(ReflectionPlane, RefusesWhatIsNoPlane) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(ReflectionPlane(Eigen::Vector3d::Zero(), 0.0), std::invalid_argument);
  EXPECT_THROW(ReflectionPlane(Eigen::Vector3d(kNaN, 0.0, 1.0), 0.0), std::invalid_argument);
  EXPECT_THROW(ReflectionPlane(Eigen::Vector3d(kInfinity, 0.0, 1.0), 0.0), std::invalid_argument);
  EXPECT_THROW(ReflectionPlane(Eigen::Vector3d::UnitX(), kNaN), std::invalid_argument);
  EXPECT_THROW(ReflectionPlane(Eigen::Vector3d::UnitX(), kInfinity), std::invalid_argument);
}

}  // namespace
