#include "pcl_symmetry/core/symmetry_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;
using Bin = PlaneGrid::Bin;

const Eigen::Vector3d kCenter(1.0, -2.0, 0.5);
constexpr double kRadius = 1.7;

PlaneGrid planeGrid(int num_theta, int num_phi, int num_radius) {
  return PlaneGrid(num_theta, num_phi, num_radius, kCenter, kRadius);
}

std::vector<PlaneGrid> someGrids() {
  return {planeGrid(1, 2, 1),  planeGrid(3, 4, 5),    planeGrid(16, 16, 16),
          planeGrid(7, 10, 9), planeGrid(32, 128, 6), planeGrid(12, 2, 3)};
}

bool operator==(const Bin& a, const Bin& b) {
  return a.theta == b.theta && a.phi == b.phi && a.radius == b.radius;
}

TEST(PlaneGrid, IndexBinAndPlaneRoundTripForEveryBin) {
  for (const PlaneGrid& g : someGrids()) {
    for (std::size_t i = 0; i < g.size(); ++i) {
      const Bin bin = g.bin(i);
      ASSERT_EQ(g.index(bin), i);
      const auto found = g.find(g.plane(bin));
      ASSERT_TRUE(found);
      ASSERT_TRUE(*found == bin) << "bin " << i << " of " << g.size();
    }
  }
}

TEST(PlaneGrid, FindsTheBinWhoseRangesHoldThePlane) {
  const PlaneGrid g = planeGrid(9, 14, 11);
  RandomStream random(2);
  for (int i = 0; i < 1000; ++i) {
    const double theta = 0.5 * kPi * random.uniform(), phi = 2.0 * kPi * random.uniform();
    const double r = kRadius * symmetric(random);
    const Eigen::Vector3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const double offset = n.dot(kCenter) + r;
    const auto bin = g.find(ReflectionPlane(n, offset)), same = g.find(ReflectionPlane(-n, -offset));
    ASSERT_TRUE(bin && same);
    EXPECT_TRUE(*bin == *same);
    EXPECT_EQ(bin->theta, static_cast<int>(theta / (0.5 * kPi / 9)));
    EXPECT_EQ(bin->phi, static_cast<int>(phi / (2.0 * kPi / 14)));
    EXPECT_EQ(bin->radius, static_cast<int>((r + kRadius) / (2.0 * kRadius / 11)));
  }
}

TEST(PlaneGrid, HasNoBinBeyondItsRadius) {
  const PlaneGrid g = planeGrid(8, 8, 8);
  const Eigen::Vector3d n = Eigen::Vector3d(1.0, 2.0, 3.0).normalized();
  EXPECT_TRUE(g.find(ReflectionPlane(n, n.dot(kCenter) + 0.999 * kRadius)));
  EXPECT_FALSE(g.find(ReflectionPlane(n, n.dot(kCenter) + 1.001 * kRadius)));
  EXPECT_FALSE(g.find(ReflectionPlane(n, n.dot(kCenter) - 1.001 * kRadius)));
}

TEST(PlaneGrid, PolesAndSeamsBelongToABin) {
  const PlaneGrid g = planeGrid(8, 8, 8);
  for (const Eigen::Vector3d& n :
       {Eigen::Vector3d(0.0, 0.0, 1.0), Eigen::Vector3d(0.0, 0.0, -1.0), Eigen::Vector3d(1.0, 0.0, 0.0),
        Eigen::Vector3d(-1.0, 0.0, 0.0), Eigen::Vector3d(0.0, -1.0, 0.0), Eigen::Vector3d(1.0, -1e-17, 0.0)}) {
    for (const double r : {-kRadius, 0.0, kRadius}) {
      // At r = +-radius, rounding may put the plane outside by a part in 1e16.
      const auto bin = g.find(ReflectionPlane(n, n.dot(kCenter) + r * (1.0 - 1e-15)));
      ASSERT_TRUE(bin) << n.transpose() << ", " << r;
      EXPECT_LT(g.index(*bin), g.size());
      EXPECT_LE(g.plane(*bin).angleTo(ReflectionPlane(n, 0.0)), 0.5 * std::hypot(g.thetaStep(), g.phiStep()));
    }
  }
}

/// A step moves the plane by one bin at most: the angle by the diagonal of a bin, the offset by one step of r.
TEST(PlaneGrid, EveryStepLandsNextDoor) {
  for (const PlaneGrid& g : {planeGrid(6, 8, 5), planeGrid(16, 16, 16), planeGrid(5, 24, 4)}) {
    for (std::size_t i = 0; i < g.size(); ++i) {
      const Bin bin = g.bin(i);
      const ReflectionPlane from = g.plane(bin);
      for (int dt = -1; dt <= 1; ++dt) {
        for (int dp = -1; dp <= 1; ++dp) {
          for (int dk = -1; dk <= 1; ++dk) {
            const auto to = g.step(bin, dt, dp, dk);
            const bool beyond = bin.radius + dk < 0 || bin.radius + dk >= g.numRadius();
            ASSERT_EQ(to.has_value(), !beyond);
            if (beyond) continue;
            const PlaneError error = planeError(from, g.plane(*to), kCenter);
            // A step in phi turns the normal by no more than phiStep * sin(theta).
            const double sine = std::sin(std::min(0.5 * kPi, g.theta(bin.theta) + g.thetaStep()));
            const double turn = std::abs(dt) * g.thetaStep() + std::abs(dp) * g.phiStep() * sine;
            ASSERT_LE(error.angle, turn + 1e-12) << "theta " << bin.theta << ", dt " << dt << ", dp " << dp;
            // Where dp = 0 the turn is exactly that of theta, across pole and equator too.
            if (dp == 0) {
              ASSERT_NEAR(error.angle, std::abs(dt) * g.thetaStep(), 1e-12);
            }
            ASSERT_NEAR(error.offset, std::abs(dk) * g.radiusStep(), 1e-12);
          }
        }
      }
    }
  }
}

TEST(PlaneGrid, NeighborsCoverAStepOfThetaAllAround) {
  // Near the pole too: every bin of the same r whose normal lies within a step of theta along a circle of latitude.
  const PlaneGrid g = planeGrid(32, 128, 3);
  for (int t = 0; t < g.numTheta(); ++t) {
    const Bin bin{t, 5, 1};
    std::set<std::size_t> neighbors;
    EXPECT_TRUE(g.visitNeighbors(bin, [&](std::size_t i) { return neighbors.insert(i), true; }));
    EXPECT_EQ(neighbors.count(g.index(bin)), 0u);
    for (int p = 0; p < g.numPhi(); ++p) {
      const int steps = std::min(std::abs(p - 5), g.numPhi() - std::abs(p - 5));
      if (p == 5 || steps * g.phiStep() * std::sin(g.theta(t)) > g.thetaStep()) continue;
      EXPECT_EQ(neighbors.count(g.index({t, p, 1})), 1u) << t << ", " << p;
    }
  }
}

TEST(PlaneGrid, VisitsItsNeighborsUntilTold) {
  int num_visited = 0;
  EXPECT_FALSE(planeGrid(8, 8, 8).visitNeighbors({4, 7, 3}, [&](std::size_t) { return ++num_visited < 3; }));
  EXPECT_EQ(num_visited, 3);
}

TEST(PlaneGrid, RefusesBadSizes) {
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PlaneGrid(0, 8, 8, kCenter, 1.0), std::invalid_argument);
  EXPECT_THROW(PlaneGrid(8, 0, 8, kCenter, 1.0), std::invalid_argument);
  EXPECT_THROW(PlaneGrid(8, 7, 8, kCenter, 1.0), std::invalid_argument);
  EXPECT_THROW(PlaneGrid(8, 8, -1, kCenter, 1.0), std::invalid_argument);
  EXPECT_THROW(PlaneGrid(5000, 8, 8, kCenter, 1.0), std::invalid_argument);
  EXPECT_THROW(PlaneGrid(8, 8, 8, kCenter, 0.0), std::invalid_argument);
  EXPECT_THROW(PlaneGrid(8, 8, 8, kCenter, -1.0), std::invalid_argument);
  EXPECT_THROW(PlaneGrid(8, 8, 8, kCenter, kNotANumber), std::invalid_argument);
  EXPECT_THROW(PlaneGrid(8, 8, 8, {0.0, kNotANumber, 0.0}, 1.0), std::invalid_argument);
}

}  // namespace
