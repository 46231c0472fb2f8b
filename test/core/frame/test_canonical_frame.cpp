/// From three planes to the canonical frame, its signs and its equally good frames.
#include "core/frame/canonical_frame.h"

#include <gtest/gtest.h>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

FrameCandidate candidate(const Eigen::Matrix3d& axes, const Eigen::Vector3f& scores) {
  FrameCandidate frame;
  frame.axes = axes.cast<float>();
  frame.offsets.setZero();
  frame.scores = scores;
  return frame;
}

TEST(CanonicalPose, TakesCenterAndAxesToOriginAndCoordinateAxes) {
  const Eigen::Isometry3d pose = randomPose(1);
  const Eigen::Isometry3d T = canonicalPose(pose.linear(), pose.translation());
  EXPECT_TRUE((T * pose).isApprox(Eigen::Isometry3d::Identity(), 1e-12));
}

TEST(PrincipalSymmetryAxes, AreOrthonormalAndPointToTheLongerTail) {
  Points points = Points::Zero(3, 5);
  points.row(0) << 0.0f, 0.0f, 1.0f, -1.0f, 0.0f;
  points.row(1) << -1.0f, -1.0f, -1.0f, -1.0f, 4.0f;
  points.row(2) << 1.0f, 1.0f, 1.0f, 1.0f, -4.0f;
  Eigen::Matrix3f rough = Eigen::Matrix3f::Identity();
  rough(0, 1) = 1e-4f;
  const Eigen::Matrix3d axes = principalSymmetryAxes(points, rough);
  EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_GT(axes.determinant(), 0.0);
  EXPECT_GT(axes(1, 1), 0.9) << "the tail of y is at 4";
  EXPECT_LT(axes(2, 2), -0.9) << "the tail of z is at -4";
}

TEST(MeanCenter, LiesBetweenFramesThatAreNearlyAsGood) {
  std::vector<FrameCandidate> frames(3, candidate(Eigen::Matrix3d::Identity(), Eigen::Vector3f::Ones()));
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].value = 2.0 - (i == 2 ? 1.0 : 0.0);
  const std::vector<Eigen::Vector3d> centers{Eigen::Vector3d::Zero(), Eigen::Vector3d(2, 4, 6),
                                             Eigen::Vector3d(100, 0, 0)};
  EXPECT_LT((meanCenter(centers, frames) - Eigen::Vector3d(1, 2, 3)).norm(), 1e-6) << "the third is far worse";
  EXPECT_EQ(meanCenter({centers[1]}, {frames[1]}), centers[1]);
}

TEST(CenterOfSymmetry, OfAWholeFollowsTheFirstPlaneAsFarAsItIsASymmetry) {
  const Points cloud = box({1.0, 0.6, 0.3}, 6000, Sampling::Random, 3).cloud();
  const PointsRef points(cloud);
  const FrameEvidence evidence(points, FrameOptions(), nullptr);
  constexpr float kAside = 5.0f;  // cells
  const auto firstOffset = [&](float score) {
    FrameCandidate frame = candidate(Eigen::Matrix3d::Identity(), Eigen::Vector3f::Constant(score));
    frame.offsets[0] = kAside;
    return evidence.toCells(centerOfSymmetry(evidence, frame)).x();
  };
  // From kAside to a middle within half a cell of 0, by 5^3 / (5^2 + d^2) cells: d is 0.06 of about 29 cells over 1 -
  // score, 174 for a symmetry and 2.5 for a score of 0.3.
  EXPECT_NEAR(firstOffset(1.0f), kAside, 0.01f);
  EXPECT_NEAR(firstOffset(0.3f), 1.0f, 0.6f);
}

TEST(EquivalentFrames, HaveEverySignThatIsARotation) {
  EquivalentFrames frames;
  const Eigen::Isometry3d pose = randomPose(2);
  frames.addWithSigns(pose.linear(), pose.translation());
  ASSERT_EQ(frames.poses().size(), 4u);
  EXPECT_TRUE(frames.poses()[0].isApprox(canonicalPose(pose.linear(), pose.translation()), 1e-12)) << "itself first";
  for (const Eigen::Isometry3d& T : frames.poses()) {
    EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-12);
    EXPECT_LT((T * pose.translation()).norm(), 1e-12);
  }
  frames.addWithSigns(pose.linear(), pose.translation());
  EXPECT_EQ(frames.poses().size(), 4u) << "each once";
}

TEST(EquivalentFrames, HaveEveryOrderOfAxesWhoseScoresTie) {
  const auto count = [](const Eigen::Vector3f& scores) {
    EquivalentFrames frames;
    frames.addTied(candidate(randomPose(3).linear(), scores), scores, 0.06, Eigen::Vector3d::Zero());
    return frames.poses().size();
  };
  EXPECT_EQ(count({0.9f, 0.7f, 0.5f}), 4u) << "signs only";
  EXPECT_EQ(count({0.9f, 0.55f, 0.5f}), 8u) << "two orders";
  EXPECT_EQ(count({0.9f, 0.88f, 0.86f}), 24u) << "all orders";
}

TEST(EquivalentFrames, LeaveOutFramesThatScoreLess) {
  const Eigen::Vector3f best(0.9f, 0.7f, 0.5f);
  EquivalentFrames frames;
  frames.addTied(candidate(randomPose(4).linear(), {0.9f, 0.7f, 0.4f}), best, 0.06, Eigen::Vector3d::Zero());
  EXPECT_TRUE(frames.poses().empty());
  frames.addTied(candidate(randomPose(4).linear(), {0.5f, 0.9f, 0.7f}), best, 0.06, Eigen::Vector3d::Zero());
  EXPECT_EQ(frames.poses().size(), 4u) << "in the order that scores enough";
}

TEST(RotationsAboutRevolution, AreNotListed) {
  SymmetryFrame result;
  const Eigen::Matrix3d rotated = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Matrix3d tilted = Eigen::AngleAxisd(0.7, Eigen::Vector3d::Ones().normalized()).toRotationMatrix();
  const Eigen::Vector3f scores = Eigen::Vector3f::Ones();
  EXPECT_FALSE(isRotatedAboutRevolution(result, candidate(rotated, scores)));
  result.revolution_axis = 1;
  EXPECT_TRUE(isRotatedAboutRevolution(result, candidate(rotated, scores)));
  EXPECT_FALSE(isRotatedAboutRevolution(result, candidate(tilted, scores)));
  result.revolution_axis = 3;
  EXPECT_TRUE(isRotatedAboutRevolution(result, candidate(tilted, scores)));
}

}  // namespace
