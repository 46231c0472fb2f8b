/// The lines of text over what the viewer shows.
#pragma once

#include <string>

#include "viewer/isp_frames.h"
#include "viewer/viewer_model.h"
#include "viewer/viewer_state.h"

namespace pcl_symmetry::apps {

/// What the legend tells beside the model and the state.
struct ViewerNotes {
  std::string name;                 ///< of the shape
  const IspFrame* frame = nullptr;  ///< the step of a refinement that is shown
  std::size_t num_frames = 0;       ///< steps of that refinement
  int num_parts = 0;                ///< that the shape is cut into
  std::string message;              ///< last line; empty for none
};

/// \return title, label of the current plane, and the legend of the colours
std::string viewerTitle(const ViewerModel& model, const ViewerState& state, const ViewerNotes& notes);

}  // namespace pcl_symmetry::apps
