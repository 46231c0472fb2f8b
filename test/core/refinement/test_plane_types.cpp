/// Results of a detection.
#include "pcl_symmetry/core/plane_types.h"

#include <gtest/gtest.h>

namespace {

using namespace pcl_symmetry;

TEST(SymmetryPlane, IsTheCanonicalFormOfItsPlane) {
  const ReflectionPlane downwards(-Eigen::Vector3d::UnitZ(), 2.0);
  const SymmetryPlane plane(downwards);
  EXPECT_EQ(plane.normal(), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(plane.offset(), -2.0);
}

}  // namespace
