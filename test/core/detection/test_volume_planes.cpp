/// Planes of functions on grids.
#include "pcl_symmetry/core/volume_planes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace {

using namespace pcl_symmetry;

TEST(VolumePlanes, TheOneThatAWedgeWasMadeWithIsFirst) {
  // Narrower toward high x, and higher: exactly symmetric about the middle of y alone.
  constexpr int kSize = 32;
  std::vector<float> values;
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const bool is_inside = x > 4 && x < 27 && std::abs(y - 15.5) < 11.0 - 0.3 * x && z > 4 && z < 10 + 0.5 * x;
        values.push_back(is_inside ? 1.0f : 0.0f);
      }
  const ScalarGrid wedge({kSize, kSize, kSize}, Eigen::Affine3d(Eigen::Translation3d(1.0, 2.0, 3.0)),
                         std::move(values));
  const Detection found = detectVolumePlanes(wedge);
  ASSERT_FALSE(found.planes.empty()) << found.reason;
  EXPECT_GT(std::abs(found.planes[0].normal().y()), std::cos(0.5 * std::acos(-1.0) / 180.0));
  EXPECT_LT(std::abs(found.planes[0].signedDistance({16.5, 17.5, 18.5})), 0.2);
  EXPECT_GT(found.planes[0].confidence, 0.9);
  EXPECT_TRUE(std::isnan(found.planes[0].share)) << "a volume has no surface";
}

TEST(VolumePlanes, AVolumeWithoutContrastGivesAReason) {
  const ScalarGrid even({8, 8, 8}, Eigen::Affine3d::Identity(), std::vector<float>(512, 1.0f));
  EXPECT_FALSE(detectVolumePlanes(even).reason.empty());
}

}  // namespace
