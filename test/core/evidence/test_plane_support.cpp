#include "core/evidence/plane_support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
