/// Frames of clouds of known meshes: what speaks for each, and which are the model's own.
#pragma once

#include <vector>

#include "core/frame/probable/probable_frames.h"
#include "evaluate/shared/model_list.h"

namespace pcl_symmetry::apps {

/// The frames of one cloud.
struct FrameSample {
  bool scanned = false;
  std::vector<FrameChoice> choices;
  std::vector<bool> right;  ///< of each: within 5 degrees of the model's axes, as probable_frames.h says
};

/// \param num_views number of scans, beside one whole cloud.
/// \throws InputError where the file has no faces.
std::vector<FrameSample> sampleFrames(const Model& model, int num_views);

}  // namespace pcl_symmetry::apps
