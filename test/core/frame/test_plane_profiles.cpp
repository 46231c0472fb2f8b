/// What frames are searched with: scores of planes of one normal, directions that the surface faces, and outlines.
#include "core/frame/plane_profiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/frame/leveled_frames.h"
#include "core/frame/surface_directions.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using namespace test;

TEST(PlaneProfiles, PeakAtThePlaneOfSymmetry) {
  GaussianEdtOptions options;
  options.radius = 1.4;
  const GaussianEdt edt(box(6000, Sampling::Mirrored, 1).cloud(), options);
  const PlaneProfiles profiles(edt, {}, 256, 1, 1);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3f normal = Eigen::Vector3f::Unit(k);
    const std::vector<float> scores = profiles.scores(normal, -20.0f, 1.0f, 41);
    EXPECT_EQ(std::max_element(scores.begin(), scores.end()) - scores.begin(), 20) << k;
    EXPECT_GT(scores[20], 0.9f) << "D of a symmetry is 1 up to sampling";
    EXPECT_EQ(scores[20], profiles.score({normal, 0.0f})) << "one plane as in a profile";
    EXPECT_LT(std::max(scores[0], scores[40]), 0.5f);
  }
}

/// Two opposite quarters of a box: no plane across x maps them onto each other, but it does once the cloud is completed
/// across y.
TEST(PlaneProfiles, CompletedCloudsHaveTheSymmetryOfTheWhole) {
  const Points whole = box(12'000, Sampling::Mirrored, 2).cloud();
  const Points quarters = pointsWhere(whole, [](const Eigen::Vector3f& x) { return x.x() * x.y() > 0.0f; });
  GaussianEdtOptions options;
  options.radius = boundingBall(whole).radius;
  const PlaneProfiles profiles(GaussianEdt(quarters, options), {}, 256, 1, 1);
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  const CellPlane across_y{Eigen::Vector3f::UnitY(), 0.0f};
  EXPECT_LT(profiles.score({x, 0.0f}), 0.4f);
  EXPECT_GT(profiles.scores(x, 0.0f, 0.0f, 1, &across_y)[0], 0.9f);
}

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
}  // namespace pcl_symmetry
