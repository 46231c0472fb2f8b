/// The directions that a surface faces.
#include "core/frame/surface_directions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(SurfaceDirections, OfABoxAreItsAxes) {
  const Eigen::Isometry3d pose = randomPose(3);
  const Points cloud = moved(box(6000, Sampling::Random, 1), pose).cloud();
  const SurfaceDirections directions(cloud, GaussianEdt(cloud));
  const std::vector<Eigen::Vector3f> peaks = directions.peaks(6);
  ASSERT_EQ(peaks.size(), 3u);
  for (const Eigen::Vector3f& peak : peaks) {
    const Eigen::Vector3d cosines = (pose.linear().transpose() * peak.cast<double>()).cwiseAbs();
    EXPECT_GT(cosines.maxCoeff(), std::cos(2.0 * kDegree));
  }
  const Eigen::Vector3d diagonal = pose.linear() * Eigen::Vector3d::Ones().normalized();
  EXPECT_LT(directions.agreement(diagonal.cast<float>()), 0.1);
  for (int k = 0; k < 3; ++k) EXPECT_GT(directions.agreement(pose.linear().col(k).cast<float>()), 0.6) << k;
}

TEST(SurfaceDirections, OfASphereAreNone) {
  const Points cloud = sphere(6000, 1).cloud();
  const SurfaceDirections directions(cloud, GaussianEdt(cloud));
  EXPECT_LE(directions.agreement(Eigen::Vector3f::UnitX()), 0.2) << "a band of 6 degrees and two caps agree";
}

}  // namespace
