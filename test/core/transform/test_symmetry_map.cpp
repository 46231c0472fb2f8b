/// Grids of planes, the maps of a transform over them, and the local maxima of maps.
#include "pcl_symmetry/core/symmetry_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "pcl_symmetry/core/planar_transform.h"
#include "shapes/shapes.h"
#include "shapes/threads.h"

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
      for (int dt = -1; dt <= 1; ++dt)
        for (int dp = -1; dp <= 1; ++dp)
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

constexpr double kGridRadius = 1.0;

struct Peak {
  ReflectionPlane plane;
  double height;
  double width = 0.2;  ///< radians, and shares of the radius
};

/// A map with Gaussian peaks: a function of planes, so that it is seamless where the grid has its seams.
SymmetryMap peaks(const PlaneGrid& grid, const std::vector<Peak>& peaks) {
  SymmetryMap map;
  map.grid = grid;
  map.center_of_mass = grid.center();
  map.values.assign(grid.size(), 0.0f);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    for (const Peak& peak : peaks) {
      const PlaneError error = planeError(peak.plane, grid.plane(grid.bin(i)), grid.center());
      const double distance = std::hypot(error.angle, error.offset / grid.radius()) / peak.width;
      map.values[i] += static_cast<float>(peak.height * std::exp(-distance * distance));
    }
  }
  return map;
}

PlaneGrid grid(int num_theta = 16, int num_phi = 64, int num_radius = 16) {
  return PlaneGrid(num_theta, num_phi, num_radius, Eigen::Vector3d::Zero(), kGridRadius);
}

ReflectionPlane plane(double theta, double phi, double r) {
  return ReflectionPlane({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}, r);
}

TEST(LocalMaxima, APeakAnywhereIsFoundOnce) {
  const std::vector<PlaneGrid> grids = {grid(16, 64, 10), grid(16, 16, 12), grid(5, 12, 9)};
  std::vector<ReflectionPlane> wanted_planes;
  for (const double r : {0.0, -0.37}) {
    for (const double phi : {0.0, 0.001, -0.02, 1.0, 3.14159, 4.0})
      for (const double theta : {0.0, 0.01, 0.04, 0.1, 0.2, 0.8, 1.5, 1.5707, 0.5 * kPi, 1.58})
        wanted_planes.push_back(plane(theta, phi, r));
  }
  for (const PlaneGrid& g : grids) {
    for (const ReflectionPlane& wanted : wanted_planes) {
      const auto found = findLocalMaxima(peaks(g, {{wanted, 0.9}}));
      ASSERT_EQ(found.size(), 1u) << wanted.coefficients().transpose() << " on " << g.numTheta() << " x " << g.numPhi();
      const PlaneError error = planeError(found[0].plane, wanted, g.center());
      // The highest bin is the nearest one; the place lies within half a bin of some bin.
      EXPECT_LE(std::hypot(error.angle, error.offset),
                0.5001 * std::hypot(std::hypot(g.thetaStep(), g.phiStep()), g.radiusStep()));
      EXPECT_EQ(g.index(found[0].bin), g.index(*g.find(found[0].plane)));
    }
  }
}

TEST(LocalMaxima, ManyPeaksComeStrongestFirst) {
  const auto map = peaks(grid(), {{plane(0.0, 0.0, 0.1), 0.5},
                                  {plane(0.5 * kPi, 0.0, 0.2), 0.9},
                                  {plane(0.5 * kPi, 0.5 * kPi, -0.3), 0.7},
                                  {plane(0.9, 4.0, 0.0), 0.3}});
  const auto found = findLocalMaxima(map);
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t i = 0; i + 1 < found.size(); ++i) EXPECT_GE(found[i].value, found[i + 1].value);
  EXPECT_LT(found[0].plane.angleTo(plane(0.5 * kPi, 0.0, 0.2)), 0.1);
  EXPECT_LT(found[3].plane.angleTo(plane(0.9, 4.0, 0.0)), 0.1);
  for (const auto& maximum : found) EXPECT_EQ(static_cast<float>(maximum.value), map[map.grid.index(maximum.bin)]);
}

TEST(LocalMaxima, WeakOnesNeedDistance) {
  // Kept at value >= 0.1 (1 - r / R) of the strongest, whose bin holds 0.99 of its height: 0.07 stands at r = 0.45,
  // where 0.055 is asked, and falls at r = 0.05, where 0.095 is.
  const Peak strongest{plane(1.0, 1.0, 0.03), 1.0};
  const auto count = [&](double r, double height, double strength) {
    LocalMaximaOptions options;
    options.strength = strength;
    options.laplacian = 0.0;
    return findLocalMaxima(peaks(grid(), {strongest, {plane(1.0, 3.5, r), height}}), options).size();
  };
  EXPECT_EQ(count(0.45, 0.07, 0.1), 2u);
  EXPECT_EQ(count(0.05, 0.07, 0.1), 1u);
  EXPECT_EQ(count(0.05, 0.07, 0.0), 2u);
  EXPECT_EQ(count(0.05, 0.15, 0.1), 2u);
  EXPECT_EQ(count(0.05, 0.15, 0.3), 1u);
}

TEST(LocalMaxima, DistanceIsMeasuredFromTheCenterOfMass) {
  // Without its shift the weak peak of WeakOnesNeedDistance at r = 0.05 falls; seen from 0.4 beside it, it stands.
  const ReflectionPlane weak = plane(1.0, 3.5, 0.05);
  auto map = peaks(grid(), {{plane(1.0, 1.0, 0.03), 1.0}, {weak, 0.07}});
  EXPECT_EQ(findLocalMaxima(map, {0.1, 0.0}).size(), 1u);
  map.center_of_mass = -0.4 * weak.normal();
  EXPECT_EQ(findLocalMaxima(map, {0.1, 0.0}).size(), 2u);
}

TEST(LocalMaxima, FlatOnesFallToTheLaplacian) {
  // Curvature goes with height / width^2: a peak of half the height and four times the width has 1/32 of it.
  const auto map = peaks(grid(), {{plane(1.0, 1.0, 0.0), 1.0, 0.15}, {plane(1.0, 1.0 + kPi, 0.1), 0.5, 0.6}});
  EXPECT_EQ(findLocalMaxima(map, {0.1, 0.1}).size(), 1u);
  EXPECT_EQ(findLocalMaxima(map, {0.1, 0.0}).size(), 2u);
  const auto sharp = peaks(grid(), {{plane(1.0, 1.0, 0.0), 1.0, 0.15}, {plane(1.0, 1.0 + kPi, 0.1), 0.5, 0.15}});
  EXPECT_EQ(findLocalMaxima(sharp, {0.1, 0.1}).size(), 2u);
}

TEST(LocalMaxima, AShoulderIsNoMaximum) {
  // Two peaks that overlap into one hill: the sum of two Gaussians less than sqrt(2) widths apart has one maximum.
  const auto map = peaks(grid(), {{plane(1.0, 1.0, 0.0), 1.0, 0.4}, {plane(1.2, 1.0, 0.1), 0.9, 0.4}});
  EXPECT_EQ(findLocalMaxima(map, {0.0, 0.0}).size(), 1u);
}

TEST(LocalMaxima, APlateauIsFoundOnce) {
  // 2 x 2 x 2 equal bins: inside the grid, across phi = 0, across the pole, across the equator.
  const PlaneGrid g = grid(16, 16, 16);
  for (const PlaneGrid::Bin& corner :
       {PlaneGrid::Bin{8, 5, 7}, PlaneGrid::Bin{8, 15, 7}, PlaneGrid::Bin{15, 2, 7}, PlaneGrid::Bin{15, 15, 9}}) {
    auto map = peaks(g, {});
    for (int dt = 0; dt <= 1; ++dt)
      for (int dp = 0; dp <= 1; ++dp)
        for (int dk = 0; dk <= 1; ++dk) map.values[g.index(*g.step(corner, dt, dp, dk))] = 0.5f;
    EXPECT_EQ(findLocalMaxima(map).size(), 1u) << corner.theta << ", " << corner.phi;
  }
  auto polar = peaks(g, {});
  for (int p = 0; p < g.numPhi(); ++p) polar.values[g.index({0, p, 7})] = 0.5f;
  EXPECT_EQ(findLocalMaxima(polar).size(), 1u);
}

TEST(LocalMaxima, NothingInAnEmptyOrZeroMap) {
  EXPECT_TRUE(findLocalMaxima(SymmetryMap{}).empty());
  EXPECT_TRUE(findLocalMaxima(peaks(grid(), {})).empty());
}

TEST(LocalMaxima, RefusesBadThresholds) {
  const auto map = peaks(grid(), {});
  EXPECT_THROW(findLocalMaxima(map, {-0.1, 0.1}), std::invalid_argument);
  EXPECT_THROW(findLocalMaxima(map, {1.1, 0.1}), std::invalid_argument);
  EXPECT_THROW(findLocalMaxima(map, {0.1, -0.1}), std::invalid_argument);
  EXPECT_THROW(findLocalMaxima(map, {0.1, std::nan("")}), std::invalid_argument);
}

TEST(SymmetryMap, PrstIsThatOfEquation1) {
  SymmetryMap map;
  map.values = {1.0f, 0.0f, -1.0f, -1.01f};  // the last one: an estimate below -1
  EXPECT_DOUBLE_EQ(map.prst(0), 1.0);
  EXPECT_DOUBLE_EQ(map.prst(1), std::sqrt(0.5));
  EXPECT_DOUBLE_EQ(map.prst(2), 0.0);
  EXPECT_DOUBLE_EQ(map.prst(3), 0.0);
}

/// The definition of pointSymmetry(): all directions, one point.
double greatest(const SymmetryMap& map, const Eigen::Vector3d& x) {
  const PlaneGrid& grid = map.grid;
  double best = 0.0;
  for (int t = 0; t < grid.numTheta(); ++t) {
    for (int p = 0; p < grid.numPhi(); ++p) {
      const double at = (grid.normal(t, p).dot(x - grid.center()) + grid.radius()) / grid.radiusStep() - 0.5;
      const int k = static_cast<int>(std::floor(at));
      const auto value = [&](int bin) {
        return bin < 0 || bin >= grid.numRadius() ? 0.0 : static_cast<double>(map[grid.index({t, p, bin})]);
      };
      const bool between = k >= 0 && k + 1 < grid.numRadius();
      const double middle = between ? (9.0 * (value(k) + value(k + 1)) - value(k - 1) - value(k + 2)) / 16.0 : 0.0;
      const double share = 2.0 * (at - k);
      best = std::max(best, share < 1.0 ? value(k) + share * (middle - value(k))
                                        : middle + (share - 1.0) * (value(k + 1) - middle));
    }
  }
  return best;
}

SymmetryMap boxMap() {
  const GaussianEdt edt(moved(box(4'000, Sampling::Random, 3), randomPose(9)).cloud());
  return sampledTransform(edt, PlaneGrid(24, 48, 32, edt.center(), edt.radius()));
}

TEST(PointSymmetry, IsTheGreatestValueOfAPlaneThroughThePoint) {
  const SymmetryMap map = boxMap();
  RandomStream random(1);
  Points probes(3, 3'000);
  for (Eigen::Index i = 0; i < probes.cols(); ++i)
    probes.col(i) =
        (map.grid.center() + 1.2 * map.grid.radius() * random.uniform() * randomDirection(random)).cast<float>();
  const std::vector<float> values = pointSymmetry(map, probes);
  for (Eigen::Index i = 0; i < probes.cols(); i += 13)
    EXPECT_NEAR(values[i], greatest(map, probes.col(i).cast<double>()), 2e-4) << i;
}

TEST(PointSymmetry, EqualBitsForAnyNumberOfThreads) {
  const SymmetryMap map = boxMap();
  const Points cloud = moved(box(4'000, Sampling::Random, 3), randomPose(9)).cloud();
  compareThreads([&](int num_threads) { return pointSymmetry(map, cloud, num_threads); });
  EXPECT_EQ(pointSymmetry(SymmetryMap(), cloud), std::vector<float>(cloud.cols(), 0.0f));
}

}  // namespace
