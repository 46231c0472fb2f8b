#include "pcl_symmetry/core/symmetry_map.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
  std::vector<ReflectionPlane> places;
  for (const double r : {0.0, -0.37}) {
    for (const double phi : {0.0, 0.001, -0.02, 1.0, 3.14159, 4.0}) {
      for (const double theta : {0.0, 0.01, 0.04, 0.1, 0.2, 0.8, 1.5, 1.5707, 0.5 * kPi, 1.58})
        places.push_back(plane(theta, phi, r));
    }
  }
  for (const PlaneGrid& g : grids) {
    for (const ReflectionPlane& place : places) {
      const auto found = findLocalMaxima(peaks(g, {{place, 0.9}}));
      ASSERT_EQ(found.size(), 1u) << place.coefficients().transpose() << " on " << g.numTheta() << " x " << g.numPhi();
      const PlaneError error = planeError(found[0].plane, place, g.center());
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

}  // namespace
