#include "pcl_symmetry/planar_symmetry_transform.h"

#include <gtest/gtest.h>

#include "pcl/clouds.h"
#include "pcl/pcl_meshes.h"

namespace pcl_symmetry {
namespace {

using test::Sampling;

TEST(PlanarSymmetryTransform, FindsThePlanesOfABoxWithEveryMethod) {
  const auto box = test::box(3000, Sampling::Random, 1);
  for (const auto method :
       {TransformMethod::Sampled, TransformMethod::Convolution, TransformMethod::Rotational, TransformMethod::Voting}) {
    PlanarSymmetryTransform<pcl::PointXYZ> transform;
    transform.setInputCloud(test::toCloud(box));
    transform.setMethod(method);
    transform.setGridSize(32);
    transform.setMapSize(16, 32, 16);
    transform.setRefinedShare(0.02);
    const SymmetryMap map = transform.compute();
    ASSERT_EQ(map.values.size(), 16u * 32u * 16u);
    EXPECT_EQ(map.method, method);
    const ReflectionPlane strongest = map.grid.plane(map.grid.bin(map.strongest()));
    double closest = 1.0;
    for (const ReflectionPlane& plane : box.planes) closest = std::min(closest, plane.angleTo(strongest));
    // Half the diagonal of a bin of 5.6 by 11.25 degrees at the equator, and half a bin for the noise of voting.
    EXPECT_LT(closest, 12.0 * test::kDegree) << "method " << static_cast<int>(method);
    EXPECT_GT(map[map.strongest()], 0.6f);
  }
}

TEST(PlanarSymmetryTransform, TakesMeshesByArea) {
  PlanarSymmetryTransform<pcl::PointXYZ> transform;
  transform.setInputMesh(test::boxMesh(), 5000);
  const SymmetryMap map = transform.compute();
  EXPECT_LT(map.center_of_mass.norm(), 0.02);
  EXPECT_NEAR(map.grid.radius(), Eigen::Vector3d(1.0, 0.7, 0.4).norm(), 0.03);
  transform.setInputMesh(pcl::PolygonMesh());
  EXPECT_TRUE(transform.compute().empty());
}

}  // namespace
}  // namespace pcl_symmetry
