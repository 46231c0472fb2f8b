/// An X display to draw on: the one that is there, or a private one of our own.
#pragma once

#include <sys/types.h>

#include <string>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

/// \return whether DISPLAY names a server that can draw with OpenGL.
bool hasDisplay();

/// While it lives, DISPLAY names a server that can draw with OpenGL. If there is none, an Xvfb is started; it ends with
/// this object, and with the program however that ends.
class PrivateDisplay {
public:
  /// \throws InputError if there is no usable display and Xvfb is missing or does not come up within ten seconds.
  PrivateDisplay();
  ~PrivateDisplay();
  PrivateDisplay(const PrivateDisplay&) = delete;
  PrivateDisplay& operator=(const PrivateDisplay&) = delete;

  /// \return true if an Xvfb had to be started.
  bool started() const { return server_ > 0; }

private:
  /// \return whether a server of our own runs now and DISPLAY names it.
  bool start();
  void stop();

  pid_t server_ = -1;
  bool had_display_ = false;
  std::string old_display_;
};

}  // namespace pcl_symmetry::apps
