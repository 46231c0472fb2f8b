#include "pcl_symmetry/core/symmetry_map.h"

#include <gtest/gtest.h>

#include "pcl_symmetry/core/planar_transform.h"
#include "shapes/shapes.h"
#include "shapes/threads.h"

namespace pcl_symmetry {
namespace {

using namespace test;

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

SymmetryMap boxMap(Points& cloud) {
  cloud = moved(box(4'000, Sampling::Random, 3), randomPose(9)).cloud();
  const GaussianEdt edt(cloud);
  return sampledTransform(edt, PlaneGrid(24, 48, 32, edt.center(), edt.radius()));
}

TEST(PointSymmetry, IsTheGreatestValueOfAPlaneThroughThePoint) {
  Points cloud;
  const SymmetryMap map = boxMap(cloud);
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
  Points cloud;
  const SymmetryMap map = boxMap(cloud);
  compareThreads([&](int num_threads) { return pointSymmetry(map, cloud, num_threads); });
  EXPECT_EQ(pointSymmetry(SymmetryMap(), cloud), std::vector<float>(cloud.cols(), 0.0f));
}

}  // namespace
}  // namespace pcl_symmetry
