#include "pictures/drawing.h"

// After Eigen, whose words it defines as macros.
#include <X11/Xlib.h>

#include <cstdlib>

namespace pcl_symmetry::apps {

bool hasDisplay() {
  if (!std::getenv("DISPLAY")) return false;
  // Stays open: an X server restarts when its last client leaves, and rejects clients in the meantime.
  static Display* const display = ::XOpenDisplay(nullptr);
  int opcode = 0, event = 0, error = 0;
  return display && ::XQueryExtension(display, "GLX", &opcode, &event, &error);
}

void requireDisplay(const std::string& name) {
  if (hasDisplay()) return;
  const char* const display = std::getenv("DISPLAY");
  throw InputError(name + ": cannot be drawn, " +
                   (display ? "the display " + std::string(display) +
                                  " cannot be reached or has no OpenGL; without DISPLAY Xvfb is used"
                            : "there is no display, and Xvfb is missing (Debian package xvfb)"));
}

}  // namespace pcl_symmetry::apps
