/// What the viewer shows, and the keys that change it; no window is needed to try them.
#pragma once

#include <string>

namespace pcl_symmetry::apps {

/// Where the camera goes next.
enum class CameraMove { Stay, Best, Worst, Along };

struct ViewerState {
  int num_planes = 0;
  bool has_mesh = false;

  int plane = 0;            ///< the current one, in [0, num_planes)
  bool patch = true;        ///< the plane itself
  bool support = true;      ///< points in the colors of their support of the plane
  bool reflection = false;  ///< the cloud reflected, over itself
  bool axes = false;        ///< principal symmetry axes; axes of revolution and centers of spheres
  bool mesh = false;        ///< the mesh under the points
  bool parts = false;       ///< segments, each in a color of its own, in place of the support
  int step = -1;            ///< of Iterative Symmetric Points, from 0; -1 = not shown
  bool help = false;        ///< the list of keys
  CameraMove camera = CameraMove::Best;
  bool save = false;  ///< a picture is wanted
  bool quit = false;
};

/// \return whether the key does anything.
bool pressKey(ViewerState& state, const std::string& symbol);

/// The list of keys, one a line.
std::string viewerHelp();

}  // namespace pcl_symmetry::apps
