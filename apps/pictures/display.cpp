#include "pictures/drawing.h"

// After Eigen, whose words it defines as macros.
#include <X11/Xlib.h>

#include <cstdlib>

namespace pcl_symmetry::apps {

bool hasDisplay() {
  Display* const display = ::XOpenDisplay(nullptr);
  if (!display) return false;
  int opcode = 0, event = 0, error = 0;
  const bool has_opengl = ::XQueryExtension(display, "GLX", &opcode, &event, &error);
  ::XCloseDisplay(display);
  return has_opengl;
}

void requireDisplay(const std::string& name) {
  if (hasDisplay()) return;
  const char* const display = std::getenv("DISPLAY");
  throw InputError(name + ": cannot be drawn, " +
                   (display ? "the display " + std::string(display) +
                                  " cannot be reached or has no OpenGL; without DISPLAY xvfb-run is used"
                            : "there is no display, and xvfb-run is missing (Debian package xvfb)"));
}

}  // namespace pcl_symmetry::apps
