#include <gtest/gtest.h>

#include "apps/support/box_mesh.h"
#include "evaluate/planes/visible_surface.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

/// A box from the corner (1, 1, 1), in its own frame: three of its faces are seen.
class VisibleSurfaceOfABox : public testing::Test {
protected:
  static TestCloud scanned() {
    TestCloud scan;
    const Eigen::Vector3d direction = Eigen::Vector3d::Ones().normalized();
    scan.view = View{direction, Eigen::Isometry3d::Identity(), 0.4};
    Eigen::Matrix3d axes;
    axes.col(2) = -direction;
    axes.col(0) = direction.unitOrthogonal();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    scan.view->T_cloud_sensor.linear() = axes;
    scan.view->T_cloud_sensor.translation() = 20.0 * direction;
    return scan;
  }
  ViewVerdict verdict(const Eigen::Vector3d& normal, double offset) const {
    return visible_.verdictOf(Answer::ofPlane(ReflectionPlane(normal, offset), 1.0));
  }

  const TriangleScene scene_{boxMesh({1.0f, 1.5f, 2.0f})};
  const MeshReflection reflection_{scene_, 10'000, 1};
  const VisibleSurface visible_{scene_, reflection_, scanned(), 0.01};
};

TEST_F(VisibleSurfaceOfABox, NothingContradictsItsPlanes) {
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_EQ(visible_.contradictedShare(ReflectionPlane(Eigen::Vector3d::Unit(axis), 0.0)), 0.0);
}

TEST_F(VisibleSurfaceOfABox, WhatLandsBeforeTheSurfaceContradicts) {
  EXPECT_EQ(verdict(Eigen::Vector3d::UnitX(), 0.5), ViewVerdict::Contradicted)
      << "x = 1 lands on x = 0, others at x > 1";
  EXPECT_GT(visible_.contradictedShare(ReflectionPlane(Eigen::Vector3d::UnitX(), 2.0)), 0.5);
}

TEST_F(VisibleSurfaceOfABox, WhatLandsBehindTheSurfaceIsUndecidable) {
  // Across the line of sight: everything that is seen lands behind what is seen.
  EXPECT_EQ(verdict(Eigen::Vector3d::Ones(), -3.0), ViewVerdict::Undecidable);
}

TEST_F(VisibleSurfaceOfABox, AnAxisIsContradictedWhereAPlaneThroughItIs) {
  const Answer axis = Answer::ofAxis(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 1.0);
  EXPECT_EQ(visible_.verdictOf(axis), ViewVerdict::Contradicted) << "a box is not round";
}

}  // namespace
