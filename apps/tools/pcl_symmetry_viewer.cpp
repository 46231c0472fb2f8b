/// A window on a cloud or mesh and its planes of symmetry; or the same as a picture.
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <string>
#include <vector>

#include "command_line/command_line.h"
#include "command_line/console.h"
#include "command_line/tool_errors.h"
#include "io/exact_coordinates.h"
#include "io/input_shape.h"
#include "pictures/drawing.h"
#include "viewer/viewer_window.h"

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
  line.positional("input", options.input, kShapeFiles)
      .picture("screenshot", options.screenshot_path, "write a picture and open no window; needs no screen")
      .text("keys", "K,K,...", options.keys, "keys pressed at the start, such as n,o,Right")
      .flag("symmetries", options.symmetries_only, "no approximate symmetries and symmetries of parts")
      .direction("up", options.model.up, "direction that is about up, input frame (0,0,1)")
      .number("width", options.width, Range::closed(200, 8192), "width of the window, pixels")
      .number("height", options.height, Range::closed(150, 8192), "height of the window, pixels")
      .number("parts", options.model.num_parts, Range::closed(0, 10'000),
              "number of parts for the key c; 0: as many as the shape has")
      .common(options.common, kShapeFlags & ~kJson);
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
  const std::vector<std::string> keys = keysOf(options);
  if (!options.screenshot_path && !hasDisplay()) {
    throw InputError("cannot open a window: there is no display that draws with OpenGL; -screenshot FILE needs none");
  }
  const Console console(options.common.quiet);

  Step loading(console, "Loading " + options.input);
  const Shape shape = loadShape(options.input);
  loading.done(std::to_string(shape.points->size()) + " points");
  warnOfLeftOut(console, options.input, shape);

  DetectionOptions& detection = options.model.detection;
  detection.approximate = !options.symmetries_only;
  options.common.applyTo(detection);
  options.model.mesh_points = options.common.mesh_points;
  options.model.viewpoint = shifted(options.common.viewpoint, shape.shift);
  Step searching(console, "Searching planes");
  const ViewerModel model = namingFile(options.input, [&] { return makeViewerModel(shape, options.model); });
  searching.done(model.summary);

  const std::string name = boost::filesystem::path(options.input).stem().string();
  std::optional<Step> drawing;
  if (options.screenshot_path) {
    drawing.emplace(console, "Drawing " + *options.screenshot_path);
    requireDisplay(*options.screenshot_path);
  }
  showModel(model, name, keys, options.width, options.height, options.screenshot_path);
  if (drawing) drawing->done();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
