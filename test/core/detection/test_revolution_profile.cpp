#include "pcl_symmetry/core/revolution_profile.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/constants.h"
#include "core/base/random.h"

namespace pcl_symmetry {
namespace {

SymmetryAxis zAxis() {
  SymmetryAxis axis;
  axis.point.setZero();
  axis.direction = Eigen::Vector3d::UnitZ();
  return axis;
}

/// Radius of a vase at a height in [0, 1].
double radiusOfVase(double height) {
  return 0.25 + 0.1 * std::sin(2.0 * kPi * height) - 0.05 * height;
}

/// A vase with a bottom.
Points vase(const SymmetryAxis& axis, int size) {
  RandomStream random(4);
  const Eigen::Vector3d u = axis.direction.unitOrthogonal(), v = axis.direction.cross(u);
  Points points(3, size);
  for (int i = 0; i < size; ++i) {
    const double angle = 2.0 * kPi * random.uniform();
    double height = random.uniform(), radius = radiusOfVase(height);
    if (i % 8 == 0) {
      height = 0.0;
      radius = radiusOfVase(0.0) * std::sqrt(random.uniform());
    }
    const Eigen::Vector3d x =
        axis.point + height * axis.direction + radius * (std::cos(angle) * u + std::sin(angle) * v);
    points.col(i) = x.cast<float>();
  }
  return points;
}

TEST(RevolutionProfile, ReachesTheAxisAndIsExactWithoutNoise) {
  const SymmetryAxis axis = zAxis();
  const std::vector<ProfilePoint> profile = revolutionProfile(vase(axis, 20'000), axis);
  double least = 1.0;
  for (const ProfilePoint& point : profile) {
    least = std::min(least, point.radius);
    if (point.height < 0.05 || point.height > 0.95) continue;
    EXPECT_NEAR(point.radius, radiusOfVase(point.height), 5e-4);
  }
  EXPECT_LT(least, 0.01);
}

TEST(RevolutionProfile, RefusesTooFewPoints) {
  EXPECT_THROW(revolutionProfile(Points::Random(3, 19), zAxis()), std::invalid_argument);
  EXPECT_THROW(revolutionProfile(Points::Random(3, 100), zAxis(), 1), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
