/// The weights of the probabilities of frames.
#include "calibrate/frames/frame_fitting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

/// Clouds with three frames each, whose right one is drawn with known weights.
std::vector<FrameSample> drawn(const FrameTerms& weights, int num_clouds) {
  RandomStream random(1);
  std::vector<FrameSample> samples;
  for (int cloud = 0; cloud < num_clouds; ++cloud) {
    FrameSample sample;
    sample.scanned = cloud % 2 == 0;
    sample.choices.resize(3);
    for (FrameChoice& choice : sample.choices) {
      choice.terms << 1.0, -random.uniform(), random.uniform(), random.uniform(), random.uniform(), 0.0,
          random.uniform(), 0.0;
    }
    FrameTerms& first = sample.choices[0].terms;
    first[5] = 1.0;
    first[7] = first[2];
    double left = random.uniform();
    for (const double p : frameProbabilities(sample.choices, weights)) {
      sample.right.push_back(left >= 0.0 && left < p);
      left -= p;
    }
    samples.push_back(sample);
  }
  return samples;
}

TEST(FrameFitting, FindsTheWeightsThatDrewTheFrames) {
  FrameTerms weights;
  weights << -1.0, 2.0, 1.0, 1.5, -2.0, 1.0, 0.5, -1.5;
  const FrameWeights fit = fitFrameWeights(drawn(weights, 40'000));
  // derived: with 20 000 clouds a kind the standard error of a weight is at most about 0.06.
  EXPECT_LT((fit.whole - weights).cwiseAbs().maxCoeff(), 0.2) << fit.whole.transpose();
  EXPECT_LT((fit.scan - weights).cwiseAbs().maxCoeff(), 0.2) << fit.scan.transpose();
}

TEST(FrameFitting, IsFiniteWhereTheFirstFrameIsAlwaysRight) {
  FrameTerms weights;
  weights << 1.0, 2.0, 1.0, 1.5, -2.0, 1.0, 0.5, 1.5;
  std::vector<FrameSample> samples = drawn(weights, 400);
  for (FrameSample& sample : samples) sample.right = {true, false, false};
  const FrameWeights fit = fitFrameWeights(samples);
  EXPECT_TRUE(fit.whole.allFinite());
  const std::vector<double> p = frameProbabilities(samples[1].choices, fit.whole);
  EXPECT_GT(p[0], 0.9);
}

TEST(FrameFitting, WritesTheHeaderOfTheLibrary) {
  const std::string text = headerText(FrameWeights{}, 3, 7);
  EXPECT_NE(text.find("7 clouds of 3 models"), std::string::npos);
  EXPECT_NE(text.find("kFrameFit{{0, 0, 0, 0, 0, 0, 0, 0}"), std::string::npos) << text;
}

}  // namespace
