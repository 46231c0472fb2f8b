/// The outline of points seen along an axis.
#include "core/frame/leveled_frames.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

/// A house seen along y: 4 wide along x, 2 high up to its eaves and 3 up to its ridge.
Points house() {
  Points points(3, 6);
  points << -2, 2, 2, 0, -2, 0,  //
      0, 1, 0, 1, 0, 0,          //
      0, 0, 2, 3, 2, 1;
  return points;
}

TEST(Outline, HasTheBoxAndTheContactOfItsCorners) {
  const Outline outline(house(), Eigen::Vector3f::UnitY());
  const Outline::Box upright = outline.boxAt(outline.angleOf(Eigen::Vector3f::UnitX()));
  EXPECT_NEAR(upright.area, 12.0, 1e-4) << "4 x 3";
  EXPECT_NEAR(upright.contact, 1.0, 1e-4) << "it stands on its longer side";
  const Outline::Box tilted = outline.boxAt(outline.angleOf(Eigen::Vector3f(1.0f, 0.0f, 0.3f)));
  EXPECT_GT(tilted.area, upright.area);
  EXPECT_LT(tilted.contact, 0.1) << "it stands on a corner";
}

TEST(Outline, AnglesAndDirectionsAreInverse) {
  const Eigen::Vector3f along = randomPose(5).linear().col(0).cast<float>();
  const Outline outline(house(), along);
  for (const double angle : {-3.0, -1.0, 0.0, 0.5, 2.0}) {
    EXPECT_NEAR(outline.angleOf(outline.direction(angle)), angle, 1e-5);
    EXPECT_NEAR(outline.direction(angle).dot(along), 0.0f, 1e-6f);
    EXPECT_NEAR(outline.direction(angle).norm(), 1.0f, 1e-6f);
  }
}

TEST(Outline, OfPointsWithoutExtentHasNoContact) {
  for (const int count : {1, 3}) {
    const Outline::Box box = Outline(Points::Zero(3, count), Eigen::Vector3f::UnitZ()).boxAt(0.3);
    EXPECT_EQ(box.area, 0.0);
    EXPECT_EQ(box.contact, 0.0);
  }
}

}  // namespace
