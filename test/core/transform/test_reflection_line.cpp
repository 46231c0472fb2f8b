#include "pcl_symmetry/core/line_transform.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using namespace test;

TEST(ReflectionLine, ReflectingTwiceIsTheIdentity) {
  RandomStream random(5);
  for (int i = 0; i < 100; ++i) {
    const ReflectionLine line(10.0 * symmetric(random), symmetric(random));
    const Eigen::Vector2d x(symmetric(random), symmetric(random));
    EXPECT_LT((line.reflect(line.reflect(x)) - x).norm(), 1e-14);
    EXPECT_NEAR(line.signedDistance(line.reflect(x)), -line.signedDistance(x), 1e-14);
    const ReflectionLine canonical = line.canonical();
    EXPECT_GE(canonical.theta(), 0.0);
    EXPECT_LT(canonical.theta(), kPi);
    EXPECT_LT((canonical.reflect(x) - line.reflect(x)).norm(), 1e-14);
  }
  EXPECT_LT(ReflectionLine(-1e-17, 1.0).canonical().theta(), kPi);
  EXPECT_THROW(ReflectionLine(std::numeric_limits<double>::quiet_NaN(), 0.0), std::invalid_argument);
}

TEST(ReflectionLine, ReflectsAsWritten) {
  // x - 2 (n.x - r) n for n = (1, 0), r = 2 turns (5, 3) into (-1, 3).
  EXPECT_EQ(ReflectionLine(0.0, 2.0).reflect({5.0, 3.0}), Eigen::Vector2d(-1.0, 3.0));
  EXPECT_EQ(ReflectionLine().reflect({5.0, 3.0}), Eigen::Vector2d(-5.0, 3.0));
}

TEST(ReflectionLine, AngleIsThatOfLines) {
  const ReflectionLine line(0.4, 1.0);
  for (const double angle : {0.0, 1e-6, 0.3, 0.5 * kPi}) {
    EXPECT_NEAR(line.angleTo(ReflectionLine(0.4 + angle, -3.0)), angle, 1e-15);
    EXPECT_NEAR(line.angleTo(ReflectionLine(0.4 - angle + kPi, 2.0)), angle, 1e-15);
  }
}

TEST(ReflectionLine, RefusesWhatIsNotFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(ReflectionLine(kInfinity, 0.0), std::invalid_argument);
  EXPECT_THROW(ReflectionLine(0.0, kInfinity), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
