/// The search finds a pose from nowhere; where it starts, how it scores and improves.
#include "pcl_symmetry/core/pose_search.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/registration/pose_evidence.h"
#include "core/registration/pose_scoring.h"
#include "core/registration/posed_surface.h"
#include "pcl_symmetry/core/visibility.h"
#include "shapes/scans.h"

namespace pcl_symmetry {
namespace {

using namespace test;

PosedSurface surface(const Points& points, std::optional<Visibility> seen = {}) {
  return {points, std::move(seen), 1, 0};
}

TEST(PoseSearch, FindsAnyPoseOfAWhole) {
  const Shape shape = asymmetricBlob(4000, 1);
  const PosedSurface model = surface(shape.cloud());
  for (int i = 0; i < 3; ++i) {
    const Eigen::Isometry3d T_model_scan = randomPose(10 + i, 0.5);
    const PosedSurface scan = surface(moved(asymmetricBlob(4000, 2), T_model_scan.inverse()).cloud());
    const std::vector<RankedPose> poses = searchPoses(scan, model, {});
    ASSERT_FALSE(poses.empty());
    EXPECT_LE(poses.size(), 4u);
    EXPECT_LT(angleOf((poses.front().T_model_scan * T_model_scan.inverse()).linear()), 0.05) << i;
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
  refused([](PoseSearchOptions& o) { o.num_threads = -1; });
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
    for (const Eigen::Matrix3d& rotation : rotations) least = std::min(least, angleOf(rotation.transpose() * wanted));
    EXPECT_LT(least, 20.0 * kDegree) << "balls of 14 degrees about 1000 rotations would fill the space once";
  }
}

TEST(PoseStarts, OfWholesPutCenterOfMassOnCenterOfMass) {
  const Shape shape = asymmetricBlob(1000, 1);
  const PosedSurface model = surface(shape.cloud()), scan = surface(moved(shape, randomPose(3)).cloud());
  const Eigen::Matrix3d rotation = randomPose(5).linear();
  const Eigen::Isometry3d start = PoseStarts(scan, model).pose(rotation);
  EXPECT_EQ(start.linear(), rotation);
  EXPECT_LT((start * centerOfMass(scan.points) - centerOfMass(model.points)).norm(), 1e-6);
}

/// With the right rotation the outline of a scan stands where the object is, though its center of mass does not.
TEST(PoseStarts, OfScansPutOutlineOnOutline) {
  const BlockObject object = blockBox();
  const PosedSurface model = surface(surfaceOf(object, 4000));
  for (const Eigen::Vector3d& viewpoint : {Eigen::Vector3d(0.0, -6.0, 0.0), Eigen::Vector3d(4.0, 3.0, -3.0)}) {
    const Scan scanned = test::scan(object, viewpoint);
    const PosedSurface scan = surface(scanned.cloud(), scanned.visibility());
    const Eigen::Isometry3d start = PoseStarts(scan, model).pose(Eigen::Matrix3d::Identity());
    EXPECT_LT(start.translation().norm(), 0.15) << viewpoint.transpose();
    EXPECT_GT((centerOfMass(model.points) - centerOfMass(scan.points)).norm(), 0.3) << viewpoint.transpose();
  }
}

/// A frame in some pose, with no equally good ones.
SymmetryFrame frameAt(const Eigen::Isometry3d& T_canonical_input, int revolution_axis = -1) {
  SymmetryFrame frame;
  frame.T_canonical_input = T_canonical_input;
  frame.center = T_canonical_input.inverse().translation();
  frame.axes = T_canonical_input.linear().transpose();
  frame.revolution_axis = revolution_axis;
  frame.equivalent = {T_canonical_input};
  frame.num_maxima = 1;
  return frame;
}

TEST(FrameHypotheses, AreAllWaysToLayAxesOnAxes) {
  const SymmetryFrame a = frameAt(randomPose(1)), b = frameAt(randomPose(2));
  const std::vector<Eigen::Isometry3d> hypotheses = frameHypotheses(a, b);
  ASSERT_EQ(hypotheses.size(), 24u);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    EXPECT_LT((hypotheses[i] * a.center - b.center).norm(), 1e-9) << "center on center";
    const Eigen::Matrix3d cosines = b.axes.transpose() * hypotheses[i].linear() * a.axes;
    EXPECT_LT((cosines.cwiseAbs().colwise().maxCoeff().array() - 1.0).abs().maxCoeff(), 1e-9) << "axes on axes";
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(angleOf((hypotheses[i] * hypotheses[j].inverse()).linear()), 10.0 * kDegree) << "each once";
  }
}

/// 24 ways times 8 turns, of which the 4 by quarter turns are among the 24 already.
TEST(FrameHypotheses, TurnAboutAnAxisOfRevolution) {
  const SymmetryFrame b = frameAt(randomPose(2));
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(frameHypotheses(frameAt(randomPose(1), axis), b).size(), 48u) << axis;
  EXPECT_EQ(frameHypotheses(frameAt(randomPose(1), 3), b).size(), 24u) << "a sphere fits in any of them";
}

TEST(FrameHypotheses, StartFromEveryFrameThatIsAMaximum) {
  SymmetryFrame a = frameAt(randomPose(1));
  const Eigen::Isometry3d turned = Eigen::AngleAxisd(30.0 * kDegree, Eigen::Vector3d::UnitZ()) * a.T_canonical_input;
  a.equivalent.push_back(turned);
  const SymmetryFrame b = frameAt(Eigen::Isometry3d::Identity());
  EXPECT_EQ(frameHypotheses(a, b).size(), 24u) << "a frame between the maxima";
  a.num_maxima = 2;
  const std::vector<Eigen::Isometry3d> hypotheses = frameHypotheses(a, b);
  EXPECT_EQ(hypotheses.size(), 48u);
  EXPECT_TRUE(std::any_of(hypotheses.begin(), hypotheses.end(),
                          [&](const Eigen::Isometry3d& pose) { return pose.isApprox(turned, 1e-9); }));
}

TEST(PoseScorer, TheTruePoseIsBestAndStandsStill) {
  const Shape shape = asymmetricBlob(4000, 1);
  const Eigen::Isometry3d T_model_scan = randomPose(4, 0.5);
  const PosedSurface model = surface(shape.cloud()), scan = surface(moved(shape, T_model_scan.inverse()).cloud());
  const PoseScorer scorer(scan, model);
  const PoseScorer::Detail detail{1000, 0.1, true};
  const PoseScore score = scorer.score(T_model_scan, detail);
  EXPECT_GT(score.support, 0.95);
  EXPECT_EQ(score.conflict, 0.0) << "nobody looked";
  EXPECT_LT(angleOf((scorer.step(T_model_scan, detail) * T_model_scan.inverse()).linear()), 0.01);
  for (const double angle : {0.2, 0.5}) {
    Eigen::Isometry3d turned = T_model_scan;
    turned.linear() = T_model_scan.linear() * Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized());
    EXPECT_LT(scorer.score(turned, detail).merit(), score.merit() - 0.05) << angle;
  }
}

TEST(PoseScorer, FreeSpaceCountsAgainstAPose) {
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

TEST(PoseEvidence, MissingSurfaceIsReported) {
  const BlockObject object = blockChair();
  const Scan scan = test::scan(object, {3.0, -6.0, 4.0}), other = test::scan(object, {-3.0, -6.0, 4.0});
  const PosedSurface seen = surface(scan.cloud(), scan.visibility()), unseen = surface(scan.cloud());
  const Eigen::Isometry3d true_pose = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d over(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  for (const PosedSurface& onto : {surface(surfaceOf(object, 4000)), surface(other.cloud(), other.visibility())}) {
    const PoseEvidence evidence = poseEvidence(seen, onto, true_pose), upside_down = poseEvidence(seen, onto, over);
    EXPECT_LT(evidence.contradicted, 0.03);
    EXPECT_LT(evidence.missing, 0.1);
    EXPECT_GT(upside_down.contradicted + upside_down.missing, 0.3);
    EXPECT_GT(poseConfidence(evidence), 0.5);
    EXPECT_LT(poseConfidence(upside_down), 0.1);
  }
  const PoseEvidence nobody_looked = poseEvidence(unseen, surface(surfaceOf(object, 4000)), over);
  EXPECT_EQ(nobody_looked.contradicted + nobody_looked.missing, 0.0);
}

TEST(PoseEvidence, TwoSidesOfASheetAreNotOneSurface) {
  const BlockObject sheet{{{Eigen::Vector3d::Zero(), {1.0, 0.05, 0.7}}}, {}};
  const Scan front = test::scan(sheet, {1.0, -6.0, 2.0}), rear = test::scan(sheet, {-1.0, 6.0, 2.0});
  const PosedSurface of_front = surface(front.cloud(), front.visibility()),
                     of_rear = surface(rear.cloud(), rear.visibility()), unseen = surface(rear.cloud());
  const Eigen::Isometry3d onto(Eigen::Translation3d(0.0, 0.1, 0.0));  // the front onto the rear
  EXPECT_GT(poseEvidence(of_front, unseen, onto).on_surface, 0.8);
  EXPECT_LT(poseEvidence(of_front, of_rear, onto).on_surface, 0.2);
  EXPECT_LT(poseEvidence(of_front, of_rear, onto).overlap_source, 0.2);
}

}  // namespace
}  // namespace pcl_symmetry
