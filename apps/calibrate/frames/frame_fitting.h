/// The weights of frameProbabilities() by maximum likelihood, and the C++ header that holds them.
#pragma once

#include <string>
#include <vector>

#include "calibrate/frames/frame_samples.h"

namespace pcl_symmetry::apps {

struct FrameWeights {
  FrameTerms whole = FrameTerms::Zero(), scan = FrameTerms::Zero();

  const FrameTerms& of(const FrameSample& sample) const { return sample.scanned ? scan : whole; }
};

/// Maximises the probability that one of the right frames of each cloud is right, or none where none is.
/// \param samples of whole clouds and of scans.
FrameWeights fitFrameWeights(const std::vector<FrameSample>& samples);

/// The text of src/core/frame/probable/frame_fit.h.
std::string headerText(const FrameWeights& weights, std::size_t num_models, std::size_t num_clouds);

}  // namespace pcl_symmetry::apps
