#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/frame/frame_hypotheses.h"
#include "core/neighbours/closest_point_grid.h"
#include "core/registration/pose_search.h"
#include "shapes/scans.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

double angleOf(const Eigen::Isometry3d& motion) {
  return Eigen::AngleAxisd(motion.linear()).angle();
}

TEST(ClosestPointGrid, IsAsExactAsItsCells) {
  const Points points = asymmetricBlob(2000, 1).cloud();
  const ClosestPointGrid grid(points, 32);
  const double cell = 2.0 * 1.25 * boundingBall(points).radius / 32;
  RandomStream random(3);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f x(1.5 * symmetric(random), 1.5 * symmetric(random), 1.5 * symmetric(random));
    const float least = std::sqrt((points.colwise() - x).colwise().squaredNorm().minCoeff());
    const float found = (points.col(grid.closest(x)) - x).norm();
    // x and its cell's center are half a diagonal apart at most; what the sweeps miss is far less than a cell.
    EXPECT_LE(found, least + 2.0 * 0.5 * std::sqrt(3.0) * cell + 0.1 * cell);
  }
}

TEST(ClosestPointGrid, AnswersFarOutsideAndForOnePoint) {
  const Points one = Points::Constant(3, 1, 2.0f);
  EXPECT_EQ(ClosestPointGrid(one).closest({1e6f, -1e6f, 0.0f}), 0);
  Points two(3, 2);
  two << -1, 1, 0, 0, 0, 0;
  EXPECT_EQ(ClosestPointGrid(two).closest({-50.0f, 3.0f, 3.0f}), 0);
  EXPECT_EQ(ClosestPointGrid(two).closest({50.0f, 3.0f, 3.0f}), 1);
  EXPECT_THROW(ClosestPointGrid(Points(3, 0)), std::invalid_argument);
}

TEST(UniformRotations, CoverAllRotations) {
  constexpr int kNumRotations = 1000;
  const std::vector<Eigen::Matrix3d> rotations = uniformRotations(kNumRotations);
  ASSERT_EQ(rotations.size(), static_cast<std::size_t>(kNumRotations));
  for (const Eigen::Matrix3d& rotation : rotations) {
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-9);
    EXPECT_LT((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  }
  for (int i = 0; i < 300; ++i) {
    const Eigen::Matrix3d wanted = randomPose(i).linear();
    double least = kPi;
    for (const Eigen::Matrix3d& rotation : rotations)
      least = std::min(least, Eigen::AngleAxisd(rotation.transpose() * wanted).angle());
    EXPECT_LT(least, 20.0 * kDegree) << "balls of 14 degrees about 1000 rotations would fill the space once";
  }
}

TEST(FrameHypotheses, HoldTheMotionBetweenTwoPosesOfAShape) {
  const Shape shape = box(4000, Sampling::Mirrored, 1);
  const Eigen::Isometry3d T_b_a = randomPose(9);
  const SymmetryFrame a = symmetryFrame(shape.cloud()), b = symmetryFrame(moved(shape, T_b_a).cloud());
  const std::vector<Eigen::Isometry3d> hypotheses = frameHypotheses(a, b);
  EXPECT_GE(hypotheses.size(), 24u);
  double least = kPi;
  for (const Eigen::Isometry3d& hypothesis : hypotheses) least = std::min(least, angleOf(T_b_a.inverse() * hypothesis));
  EXPECT_LT(least, 3.0 * kDegree);
}

class PoseSearchTest : public testing::Test {
protected:
  static PosedSurface surface(const Points& points, std::optional<Visibility> seen = {}) {
    return {points, std::move(seen), 1, 0};
  }
};

TEST_F(PoseSearchTest, TheTruePoseIsBestAndStandsStill) {
  const Shape shape = asymmetricBlob(4000, 1);
  const Eigen::Isometry3d T_model_scan = randomPose(4, 0.5);
  const PosedSurface model = surface(shape.cloud()), scan = surface(moved(shape, T_model_scan.inverse()).cloud());
  const PoseScorer scorer(scan, model);
  const PoseScorer::Detail detail{1000, 0.1, true};
  const PoseScore score = scorer.score(T_model_scan, detail);
  EXPECT_GT(score.support, 0.95);
  EXPECT_EQ(score.conflict, 0.0) << "nobody looked";
  EXPECT_LT(angleOf(scorer.step(T_model_scan, detail) * T_model_scan.inverse()), 0.01);
  for (const double angle : {0.2, 0.5}) {
    Eigen::Isometry3d turned = T_model_scan;
    turned.linear() = T_model_scan.linear() * Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized());
    EXPECT_LT(scorer.score(turned, detail).merit(), score.merit() - 0.05) << angle;
  }
}

TEST_F(PoseSearchTest, StepsLeadToTheTruePose) {
  const Shape shape = asymmetricBlob(4000, 1);
  const PosedSurface model = surface(shape.cloud()), scan = surface(asymmetricBlob(4000, 2).cloud());
  const PoseScorer scorer(scan, model);
  Eigen::Isometry3d pose(Eigen::AngleAxisd(0.15, Eigen::Vector3d(3, 1, -2).normalized()));
  pose.translation() = Eigen::Vector3d(0.05, -0.1, 0.1);
  for (int i = 0; i < 30; ++i) pose = scorer.step(pose, {1000, 0.2});
  EXPECT_LT(angleOf(pose), 0.02);
  EXPECT_LT(pose.translation().norm(), 0.02);
}

TEST_F(PoseSearchTest, FindsAnyPoseOfAWhole) {
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

TEST_F(PoseSearchTest, FreeSpaceSpeaksAgainstAPose) {
  const BlockObject object = blockChair();
  const Scan scan = test::scan(object, {3.0, -6.0, 4.0});
  const PosedSurface seen = surface(scan.cloud(), scan.visibility()), unseen = surface(scan.cloud());
  // The chair upside down: what is then above the seat was seen to be empty.
  const Eigen::Isometry3d over(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  const PosedSurface model = surface(surfaceOf(object, 4000));
  const PoseScorer::Detail detail{1000, 0.1, true};
  EXPECT_EQ(PoseScorer(unseen, model).score(over, detail).conflict, 0.0);
  EXPECT_GT(PoseScorer(seen, model).score(over, detail).conflict, 0.1);
  EXPECT_LT(PoseScorer(seen, model).score(Eigen::Isometry3d::Identity(), detail).conflict, 0.02);
}

TEST_F(PoseSearchTest, GivesTheSamePosesForAnyNumberOfThreads) {
  const PosedSurface model = surface(asymmetricBlob(1000, 1).cloud()), scan = surface(asymmetricBlob(1000, 2).cloud());
  PoseSearchOptions options;
  options.num_rotations = 200;
  std::vector<RankedPose> expected;
  for (const int threads : {1, 2, 8}) {
    options.num_threads = threads;
    const std::vector<RankedPose> poses = searchPoses(scan, model, {}, options);
    if (expected.empty()) expected = poses;
    ASSERT_EQ(poses.size(), expected.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
      EXPECT_EQ(poses[i].T_model_scan.matrix(), expected[i].T_model_scan.matrix());
  }
}

TEST_F(PoseSearchTest, RefusesOptionsOutOfRange) {
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
  refused([](PoseSearchOptions& o) { o.num_threads = -1; });
}

}  // namespace
