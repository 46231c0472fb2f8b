/// Pairs of points and landmarks; meshes that are made symmetric are tested through the Python module.
#include "pcl_symmetry/core/symmetrized_shape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pcl_symmetry {
namespace {

const ReflectionPlane kPlane(Eigen::Vector3d::UnitX(), 0.0);

TEST(ReflectedPairs, FindsWhatIsThere) {
  Points points(3, 4);
  points << 1, -1.001f, 2, 0, 0, 0, 1, 3, 0, 0, 0, 0;
  const ReflectedPairs pairs = reflectedPairs(points, kPlane, 0.01);
  EXPECT_EQ(pairs.index, (std::vector<int>{1, 0, -1, 3}));
  EXPECT_NEAR(pairs.sq_distances[0], 1e-6, 1e-8);
}

TEST(LandmarkAsymmetry, MeasuresPairsAndTheMidline) {
  const LandmarkAsymmetry found = landmarkAsymmetry({{{1.0, 0.0, 0.0}, {-1.0, 0.3, 0.4}}}, {{0.5, 0.0, 0.0}}, kPlane);
  EXPECT_TRUE(found.paired[0].isApprox(Eigen::Vector3d(0.0, -0.3, -0.4)));
  EXPECT_NEAR(found.paired_rms, 0.5, 1e-12);
  EXPECT_NEAR(found.unpaired[0], 0.5, 1e-12);
  EXPECT_NEAR(found.object_rms, std::sqrt((2.0 * 0.25 * 0.25 + 0.25) / 3.0), 1e-12);
  EXPECT_EQ(landmarkAsymmetry({}, {}, kPlane).object_rms, 0.0);
}

}  // namespace
}  // namespace pcl_symmetry
