/// A window on a shape and its planes: PCL's visualizer, driven by the keys of viewer_state.h.
#pragma once

#include <memory>
#include <string>

#include "viewer/viewer_model.h"
#include "viewer/viewer_state.h"

namespace pcl_symmetry::apps {

/// Needs a display (drawing.h).
class ViewerWindow {
public:
  /// \param name of the shape, in the title and in the names of saved pictures.
  /// \param off_screen draws, but shows no
  /// window and takes no mouse.
  /// \param width,height pixels.
  ViewerWindow(const ViewerModel& model, const std::string& name, bool off_screen, int width, int height);
  ~ViewerWindow();

  const ViewerState& state() const;

  /// Does what the key says and draws again.
  /// \return whether the key does anything.
  bool press(const std::string& symbol);

  /// Lets the user work until they quit.
  void run();

  /// Writes what is drawn now as a PNG, whole.
  /// \throws InputError if the file cannot be written.
  void save(const std::string& path);

private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pcl_symmetry::apps
