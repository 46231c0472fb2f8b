#include "viewer/viewer_state.h"

#include <algorithm>
#include <vector>

namespace pcl_symmetry::apps {

namespace {

void stepPlane(ViewerState& state, int by) {
  if (state.num_planes == 0) return;
  state.plane = (state.plane + by + state.num_planes) % state.num_planes;
  state.step = -1;
}

struct ViewerKey {
  std::vector<std::string> symbols;  ///< as X names them; the first one is shown
  std::string help;
  void (*press)(ViewerState& state);
};

/// All keys, in the order of the help.
const std::vector<ViewerKey>& viewerKeys() {
  static const std::vector<ViewerKey> keys = {
      {{"n", "Right"}, "next plane", [](ViewerState& s) { stepPlane(s, 1); }},
      {{"b", "Left"}, "plane before", [](ViewerState& s) { stepPlane(s, -1); }},
      {{"g"}, "plane on, off", [](ViewerState& s) { s.patch = !s.patch; }},
      {{"s"}, "support on, off: yellow points have a counterpart", [](ViewerState& s) { s.support = !s.support; }},
      {{"o"}, "reflected points over the others, on, off", [](ViewerState& s) { s.reflection = !s.reflection; }},
      {{"a"}, "center of symmetry and axes on, off", [](ViewerState& s) { s.axes = !s.axes; }},
      {{"m"}, "mesh on, off", [](ViewerState& s) { s.mesh = s.has_mesh && !s.mesh; }},
      {{"c"}, "parts in colors of their own on, off", [](ViewerState& s) { s.parts = !s.parts; }},
      {{"i"}, "refinement: start, next step", [](ViewerState& s) { s.step += s.num_planes > 0 ? 1 : 0; }},
      {{"u"}, "refinement: step before", [](ViewerState& s) { s.step = std::max(-1, s.step - 1); }},
      {{"v"}, "best view", [](ViewerState& s) { s.camera = CameraMove::Best; }},
      {{"w"}, "worst view", [](ViewerState& s) { s.camera = CameraMove::Worst; }},
      {{"e"}, "along the plane", [](ViewerState& s) { s.camera = CameraMove::Along; }},
      {{"p"}, "save a picture", [](ViewerState& s) { s.save = true; }},
      {{"h"}, "this list on, off", [](ViewerState& s) { s.help = !s.help; }},
      {{"q", "Escape"}, "quit", [](ViewerState& s) { s.quit = true; }},
  };
  return keys;
}

}  // namespace

bool pressKey(ViewerState& state, const std::string& symbol) {
  for (const ViewerKey& key : viewerKeys()) {
    if (std::find(key.symbols.begin(), key.symbols.end(), symbol) == key.symbols.end()) continue;
    key.press(state);
    return true;
  }
  return false;
}

std::string viewerHelp() {
  std::string text;
  for (const ViewerKey& key : viewerKeys()) text += key.symbols[0] + "  " + key.help + "\n";
  return text + "mouse: left turns, middle moves, right or wheel zooms";
}

}  // namespace pcl_symmetry::apps
