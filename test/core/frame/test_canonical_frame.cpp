/// From three planes to the canonical frame, its signs, its equally good frames, and their probabilities.
#include "core/frame/canonical_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/frame/probable_frames.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

using namespace test;

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

FrameChoice choiceWith(double value) {
  FrameChoice choice;
  choice.terms[0] = 1.0;
  choice.terms[1] = value;
  return choice;
}

TEST(FrameProbabilities, AreThoseOfTheConditionalLogit) {
  FrameTerms weights = FrameTerms::Zero();
  weights.head<2>() << 0.5, 2.0;
  const std::vector<double> p = frameProbabilities({choiceWith(0.0), choiceWith(-1.0)}, weights);
  ASSERT_EQ(p.size(), 2u);
  const double a = std::exp(0.5), b = std::exp(-1.5);
  EXPECT_NEAR(p[0], a / (1.0 + a + b), 1e-12);
  EXPECT_NEAR(p[1], b / (1.0 + a + b), 1e-12);
  EXPECT_TRUE(frameProbabilities({}, weights).empty());
}

TEST(FrameProbabilities, StayFiniteForAnyWeight) {
  FrameTerms weights = FrameTerms::Zero();
  for (const double weight : {-1e4, 1e4}) {
    weights[0] = weight;
    const double p = frameProbabilities({choiceWith(0.0)}, weights)[0];
    EXPECT_NEAR(p, weight > 0.0 ? 1.0 : 0.0, 1e-12);
  }
}

TEST(FrameChoices, HaveEachFrameOnce) {
  // A slanted box: its first plane is x = 0; seen along x it is a parallelogram, which people may put on either side.
  Shape shape = box({0.3, 0.5, 1.0}, 6000, Sampling::Random, 3);
  shape.points.row(1) += 0.4 * shape.points.row(2);
  const Points cloud = moved(shape, randomPose(8)).cloud();
  const PointsRef points(cloud);
  const FrameOptions options;
  const FrameEvidence evidence(points, options, nullptr);
  const FoundFrames found = findFrames(evidence, options, [](const char*) {});
  const std::vector<FrameChoice> choices = frameChoices(evidence, found.refined, options.tie, 1);
  ASSERT_GE(choices.size(), 2u);
  EXPECT_EQ(choices.front().frame.axes, found.refined.front().axes);
  EXPECT_EQ(choices.front().terms[5], 1.0);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    EXPECT_LE(choices[i].terms[1], 0.0) << "no value above the best";
    for (std::size_t j = 0; j < i; ++j) {
      const Eigen::Matrix3f cosines = (choices[i].frame.axes.transpose() * choices[j].frame.axes).cwiseAbs();
      EXPECT_LT(cosines.rowwise().maxCoeff().minCoeff(), std::cos(2.5f * static_cast<float>(kDegree))) << i << " " << j;
    }
  }
  // One of them stands on the longer side of the parallelogram, which was y = const.
  const Eigen::Vector3f up = (randomPose(8).linear() * Eigen::Vector3d(0.0, 1.0, -0.4).normalized()).cast<float>();
  float level = 0.0f;
  for (const FrameChoice& choice : choices)
    level = std::max(level, (choice.frame.axes.transpose() * up).cwiseAbs().maxCoeff());
  EXPECT_GT(level, std::cos(3.0f * static_cast<float>(kDegree)));
}

}  // namespace
}  // namespace pcl_symmetry
