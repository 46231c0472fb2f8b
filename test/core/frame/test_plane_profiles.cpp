/// Scores of planes of one normal, also on a completed cloud.
#include "core/frame/plane_profiles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
  Points quarters(3, whole.cols());
  Eigen::Index size = 0;
  for (Eigen::Index i = 0; i < whole.cols(); ++i)
    if (whole(0, i) * whole(1, i) > 0.0f) quarters.col(size++) = whole.col(i);
  quarters.conservativeResize(3, size);
  GaussianEdtOptions options;
  options.radius = boundingBall(whole).radius;
  const PlaneProfiles profiles(GaussianEdt(quarters, options), {}, 256, 1, 1);
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  const CellPlane across_y{Eigen::Vector3f::UnitY(), 0.0f};
  EXPECT_LT(profiles.score({x, 0.0f}), 0.4f);
  EXPECT_GT(profiles.scores(x, 0.0f, 0.0f, 1, &across_y)[0], 0.9f);
}

}  // namespace
