#include "calibrate/frames/frame_fitting.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>

namespace pcl_symmetry::apps {

namespace {

constexpr int kNewtonSteps = 50;      // chosen: the steps settle in about ten
constexpr double kAtRest = 1e-10;     // chosen: far below the digits that are written
constexpr double kPull = 0.3;         // clouds, pull of each weight to 0. chosen: no weight moves by a tenth at half
constexpr double kLongestStep = 5.0;  // of a weight. chosen: keeps the first steps of separable samples finite
using Hessian = Eigen::Matrix<double, kNumFrameTerms, kNumFrameTerms>;

/// Slope and curvature of the log likelihood.
struct Slope {
  FrameTerms gradient = FrameTerms::Zero();
  Hessian curvature = Hessian::Zero();

  void add(const FrameSample& sample, const FrameTerms& weights) {
    const std::vector<double> p = frameProbabilities(sample.choices, weights);
    double right = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i)
      if (sample.right[i]) right += p[i];
    FrameTerms mean = FrameTerms::Zero();
    for (std::size_t i = 0; i < p.size(); ++i) {
      const FrameTerms& x = sample.choices[i].terms;
      const double share = right > 0.0 && sample.right[i] ? p[i] / right : 0.0;
      gradient += (share - p[i]) * x;
      mean += p[i] * x;
      curvature += p[i] * x * x.transpose();
    }
    curvature -= mean * mean.transpose();
  }
};

FrameTerms fitKind(const std::vector<FrameSample>& samples, bool scanned) {
  FrameTerms weights = FrameTerms::Zero();
  for (int step = 0; step < kNewtonSteps; ++step) {
    Slope slope;
    for (const FrameSample& sample : samples)
      if (sample.scanned == scanned) slope.add(sample, weights);
    slope.gradient -= kPull * weights;
    slope.curvature.diagonal().array() += kPull;
    const FrameTerms move = slope.curvature.ldlt().solve(slope.gradient);
    weights += move.cwiseMax(-kLongestStep).cwiseMin(kLongestStep);
    if (move.cwiseAbs().maxCoeff() < kAtRest) break;
  }
  return weights;
}

std::string listed(const FrameTerms& weights) {
  std::string text;
  char number[32];
  for (Eigen::Index k = 0; k < weights.size(); ++k) {
    std::snprintf(number, sizeof(number), "%s%.4g", k > 0 ? ", " : "", weights[k]);
    text += number;
  }
  return "{" + text + "}";
}

}  // namespace

FrameWeights fitFrameWeights(const std::vector<FrameSample>& samples) {
  return {fitKind(samples, false), fitKind(samples, true)};
}

std::string headerText(const FrameWeights& weights, std::size_t num_models, std::size_t num_clouds) {
  return "// Written by calibrate_frames. Do not edit.\n#pragma once\n\n#include <array>\n\nnamespace pcl_symmetry "
         "{\n\n/// Weights of frameProbabilities(): of whole clouds and of scans.\nstruct FrameFit {\n  "
         "std::array<double, " +
         std::to_string(kNumFrameTerms) + "> whole, scan;\n};\n\n// fitted: " + std::to_string(num_clouds) +
         " clouds of " + std::to_string(num_models) + " models.\nconstexpr FrameFit kFrameFit{" +
         listed(weights.whole) + ",\n                             " + listed(weights.scan) +
         "};\n\n}  // namespace pcl_symmetry\n";
}

}  // namespace pcl_symmetry::apps
