/// A window on a shape and its planes, driven by the keys of viewer_state.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/viewer_model.h"
#include "viewer/viewer_state.h"

namespace pcl_symmetry::apps {

/// Lets the user work until they quit; or draws off screen, and writes a picture. Needs a display (drawing.h).
/// \param name of the shape, in the title and in the names of saved pictures.
/// \param keys pressed at the start.
/// \param width,height pixels.
/// \param screenshot_path PNG that is written whole; none: a window.
/// \throws InputError if the file cannot be written.
void showModel(const ViewerModel& model, const std::string& name, const std::vector<std::string>& keys, int width,
               int height, const std::optional<std::string>& screenshot_path);

}  // namespace pcl_symmetry::apps
