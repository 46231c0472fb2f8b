/// The search finds a pose from nowhere.
#include "pcl_symmetry/core/pose_search.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/registration/ranked_poses.h"
#include "shapes/posed_surfaces.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

TEST(PoseScore, MeritIsSupportMinusHalfTheConflict) {
  PoseScore score;
  EXPECT_EQ(score.merit(), 0.0);
  score.support = 0.75;
  score.conflict = 0.5;
  EXPECT_EQ(score.merit(), 0.5);
}

TEST(PoseSearch, FindsAnyPoseOfAWhole) {
  const Shape shape = asymmetricBlob(4000, 1);
  const PosedSurface model = surface(shape.cloud());
  for (int i = 0; i < 5; ++i) {
    const Eigen::Isometry3d T_model_scan = randomPose(10 + i, 0.5);
    const PosedSurface scan = surface(moved(asymmetricBlob(4000, 2), T_model_scan.inverse()).cloud());
    const std::vector<RankedPose> poses = searchPoses(scan, model, {});
    ASSERT_FALSE(poses.empty());
    EXPECT_LE(poses.size(), 4u);
    EXPECT_LT(angleOf(poses.front().T_model_scan * T_model_scan.inverse()), 0.05) << i;
    for (std::size_t k = 1; k < poses.size(); ++k)
      EXPECT_LE(poses[k].score.merit(), poses[k - 1].score.merit()) << "best first";
  }
}

TEST(PoseSearchOptions, RefusesOptionsOutOfRange) {
  const auto refused = [](const auto& change) {
    PoseSearchOptions options;
    change(options);
    EXPECT_THROW(options.validate(), std::invalid_argument);
  };
  refused([](PoseSearchOptions& o) { o.num_rotations = -1; });
  refused([](PoseSearchOptions& o) { o.num_screened = 0; });
  refused([](PoseSearchOptions& o) { o.num_refined = 0; });
  refused([](PoseSearchOptions& o) { o.max_poses = 0; });
  refused([](PoseSearchOptions& o) { o.coarse_width = 0.0; });
  refused([](PoseSearchOptions& o) { o.fine_width = -1.0; });
  refused([](PoseSearchOptions& o) { o.merge_angle = -0.1; });
  refused([](PoseSearchOptions& o) { o.merge_distance = -0.1; });
  refused([](PoseSearchOptions& o) { o.num_threads = -1; });
}

}  // namespace
