/// The poses that two symmetry frames leave open.
#include "core/registration/frame_hypotheses.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "shapes/posed_surfaces.h"
#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
      EXPECT_GT(angleOf(hypotheses[i] * hypotheses[j].inverse()), 10.0 * kDegree) << "each once";
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

}  // namespace
