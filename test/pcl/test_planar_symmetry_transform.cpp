#include "pcl_symmetry/planar_symmetry_transform.h"

#include <gtest/gtest.h>

#include "pcl/clouds.h"
#include "pcl/pcl_meshes.h"

namespace pcl_symmetry {
namespace {

TEST(PlanarSymmetryTransform, TakesMeshesByArea) {
  PlanarSymmetryTransform<pcl::PointXYZ> transform;
  transform.setInputMesh(test::boxMesh(), 5000);
  transform.setMethod(TransformMethod::Convolution);
  const SymmetryMap map = transform.compute();
  EXPECT_EQ(map.method, TransformMethod::Convolution);
  EXPECT_LT(map.center_of_mass.norm(), 0.02);
  EXPECT_NEAR(map.grid.radius(), Eigen::Vector3d(1.0, 0.7, 0.4).norm(), 0.03);
  transform.setInputMesh(pcl::PolygonMesh());
  EXPECT_TRUE(transform.compute().empty());
}

}  // namespace
}  // namespace pcl_symmetry
