/// A window on a cloud or mesh and its planes of symmetry; or the same as a picture.
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <string>
#include <vector>

#include "console.h"
#include "options.h"
#include "private_display.h"
#include "shape_input.h"
#include "viewer_window.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct ViewerOptions {
  std::string input;
  std::optional<std::string> screenshot_path, keys;
  int width = 1000, height = 750;
  bool symmetries_only = false;
  ViewerModelOptions model;
  CommonOptions common;
};

CommandLine commandLine(ViewerOptions& options) {
  CommandLine line("pcl_symmetry_viewer", "Shows a cloud or mesh and its planes of symmetry. h lists the keys.",
                   "pcl_symmetry_viewer bull.off -up 0,1,0");
  line.positional("input", options.input, ".pcd, .ply, .obj, .stl or .off")
      .text("screenshot", "FILE", options.screenshot_path, "write a picture and open no window; needs no screen")
      .text("keys", "K,K,...", options.keys, "keys pressed at the start, such as n,o,Right")
      .flag("symmetries", options.symmetries_only, "no approximate symmetries and symmetries of parts")
      .vector("up", options.model.up, "about where up is, input frame (0,0,1)")
      .number("width", options.width, Range::closed(200, 8192), "of the window, pixels")
      .number("height", options.height, Range::closed(150, 8192), "of the window, pixels")
      .number("parts", options.model.num_parts, Range::closed(0, 10'000), "for the key c; 0: as many as the shape has")
      .number("points", options.model.mesh_points, Range::closed(100, 10'000'000), "points spread over a mesh")
      .common(options.common, kAllCommonFlags & ~kJson);
  return line;
}

std::vector<std::string> keysOf(const ViewerOptions& options) {
  std::vector<std::string> keys;
  if (options.keys) boost::algorithm::split(keys, *options.keys, boost::is_any_of(","));
  ViewerState trial;
  for (const std::string& key : keys)
    if (!pressKey(trial, key)) throw UsageError("-keys: there is no key " + key + ", h lists them");
  return keys;
}

int run(int argc, char** argv) {
  ViewerOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (options.model.up && options.model.up->norm() == 0.0) throw UsageError("-up = 0,0,0, must not be zero");
  const std::vector<std::string> keys = keysOf(options);
  if (!options.screenshot_path && !hasDisplay()) {
    throw InputError("cannot open a window: there is no display that draws with OpenGL; -screenshot FILE needs none");
  }
  const Console console(options.common.quiet);

  Step loading(console, "Loading " + options.input);
  const Shape shape = loadShape(options.input);
  loading.done(std::to_string(shape.points->size()) + " points");

  DetectionOptions& detection = options.model.detection;
  detection.approximate = !options.symmetries_only;
  detection.seed = options.common.seed + 1;
  detection.num_threads = detection.edt.num_threads = options.common.threads;
  detection.edt.num_cells = options.common.grid;
  options.model.viewpoint = options.common.viewpoint;
  Step searching(console, "Searching planes");
  ViewerModel model;
  try {
    model = makeViewerModel(shape, options.model);
  } catch (const pcl::BadArgumentException& error) {
    throw InputError(options.input + ": " + error.detailedMessage());
  }
  searching.done(model.summary);

  const std::string name = boost::filesystem::path(options.input).stem().string();
  if (!options.screenshot_path) {
    ViewerWindow window(model, name, false, options.width, options.height);
    for (const std::string& key : keys) window.press(key);
    window.run();
    return 0;
  }
  Step drawing(console, "Drawing " + *options.screenshot_path);
  const PrivateDisplay display;
  ViewerWindow window(model, name, true, options.width, options.height);
  for (const std::string& key : keys) window.press(key);
  window.save(*options.screenshot_path);
  drawing.done();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
