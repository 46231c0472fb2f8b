/// A window on a shape and its planes: PCL's visualizer, driven by the keys of viewer_state.h.
#pragma once

#include <memory>
#include <string>

#include "viewer/viewer_model.h"
#include "viewer/viewer_state.h"

namespace pcl_symmetry::apps {

class ViewerWindow {
public:
  virtual ~ViewerWindow() = default;

  /// Does what the key says and draws again.
  /// \return whether the key does anything.
  virtual bool press(const std::string& symbol) = 0;

  /// Lets the user work until they quit.
  virtual void run() = 0;

  /// Writes what is drawn now as a PNG, whole.
  /// \throws InputError if the file cannot be written.
  virtual void save(const std::string& path) = 0;
};

/// Needs a display (drawing.h).
/// \param name of the shape, in the title and in the names of saved pictures.
/// \param off_screen draws, but shows no window and takes no mouse.
/// \param width,height pixels.
std::unique_ptr<ViewerWindow> makeViewerWindow(const ViewerModel& model, const std::string& name, bool off_screen,
                                               int width, int height);

}  // namespace pcl_symmetry::apps
