#include "viewer/viewer_texts.h"

#include <cstdio>

namespace pcl_symmetry::apps {

std::string viewerTitle(const ViewerModel& model, const ViewerState& state, const ViewerNotes& notes) {
  std::string title = notes.name + ": " + model.summary;
  if (notes.frame) {
    char text[200];
    std::snprintf(text, sizeof(text),
                  "refinement of plane %d, step %d of %zu, residual %.4f radii\n"
                  "blue: samples   orange: their reflections   green: closest points",
                  state.plane + 1, state.step + 1, notes.num_frames, notes.frame->residual);
    title += std::string("\n") + text;
  } else if (state.num_planes > 0) {
    title += "\n" + model.labels[state.plane];
    if (state.reflection) title += "\norange: reflected points";
  }
  if (!notes.frame && state.parts)
    title += "\n" + std::to_string(notes.num_parts) +
             (notes.num_parts == 1 ? " part" : " parts, each in a colour of its own");
  if (state.axes) title += "\norange, green, blue: first, second, third principal symmetry axis";
  if (state.axes && !model.axes.empty()) title += "\nblack: axis of revolution";
  if (state.axes && !model.centers.empty()) title += "\nblack: every plane through their crossing is a symmetry";
  if (!notes.message.empty()) title += "\n" + notes.message;
  return title;
}

}  // namespace pcl_symmetry::apps
