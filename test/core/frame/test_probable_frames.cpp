/// Frames with their probabilities.
#include "core/frame/probable_frames.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shapes/shapes.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

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
