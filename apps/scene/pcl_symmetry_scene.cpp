/// The objects of one frame of a sensor and their symmetries: a table, JSON, the completed scene, a picture.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/command_line/file_errors.h"
#include "common/command_line/run_tool.h"
#include "common/files/file_text.h"
#include "common/files/json_values.h"
#include "common/shape_input/exact_coordinates.h"
#include "common/shape_input/input_shape.h"
#include "common/shape_output/shape_output.h"
#include "pcl_symmetry/scene/symmetry_scene.h"
#include "scene/report/scene_report.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct SceneToolOptions {
  std::string input;
  std::optional<std::string> output, database_path, png_path;
  bool no_filter = false, no_frames = false, no_completion = false;
  SceneOptions scene;
  CommonOptions common;
};

CommandLine commandLine(SceneToolOptions& o) {
  CommandLine line("pcl_symmetry_scene",
                   "Finds the objects of one frame of a depth camera or scanner, and their symmetries.",
                   "pcl_symmetry_scene table.pcd completed.pcd -json objects.json -png objects.png");
  line.positional("input", o.input, ".pcd or .ply: organized, or with the viewpoint of the sensor")
      .positional(
          "output", o.output,
          "completed scene, .pcd or .ply, with the fields object (-1 = supporting plane, 0 = none) and completed")
      .text("database", "FILE", o.database_path, "names objects by the models of this file of pcl_symmetry_database")
      .picture("png", o.png_path, "picture: the scene, and each object with what its symmetry adds")
      .number("max_range", o.scene.max_range, Range::atLeast(0),
              "points farther from the sensor are left out, input units; 0 = none is")
      .number("plane_distance", o.scene.plane_distance, Range::atLeast(0),
              "distance of points that belong to a supporting plane, input units; 0 = from the points")
      .number("cluster_distance", o.scene.cluster_distance, Range::atLeast(0),
              "distance between points of one object, input units; 0 = from the points")
      .number("min_points", o.scene.min_points, Range::closed(20, 1'000'000'000), "least number of points of an object")
      .number("max_points", o.scene.max_points, Range::closed(100, 1'000'000'000),
              "points of an object that are analysed")
      .number("min_confidence", o.scene.detection.min_confidence, Range::closed(0, 1),
              "least probability of a plane that is called a symmetry")
      .flag("no_filter", o.no_filter, "leaves the errors of a depth camera in organized frames")
      .flag("no_frames", o.no_frames, "leaves the frames of the objects out")
      .flag("no_completion", o.no_completion, "leaves the completion of the objects out")
      .common(o.common, kAnalysisFlags);
  return line;
}

SceneAnalysis analyse(const Console& console, const InputShape& input, const SceneToolOptions& options) {
  SymmetryScene scene;
  SceneOptions used = options.scene;
  options.common.applyTo(used.detection);
  options.common.applyTo(used.frame);
  used.num_threads = used.recognition.num_threads = options.common.threads;
  used.filter = !options.no_filter;
  used.frames = !options.no_frames;
  used.complete = !options.no_completion;
  scene.setOptions(used);
  scene.setViewpoint(shifted(options.common.viewpoint, input.shift()));
  if (options.database_path) {
    checkReadableFile(*options.database_path);
    scene.setDatabase(namingFile(*options.database_path,
                                 [&] { return std::make_shared<const SymmetryDatabase>(*options.database_path); }));
  }
  scene.setInputCloud(input.points);
  Step searching(console, "Searching objects");
  SceneAnalysis found;
  namingFile(input.path, [&] { found = scene.compute(); });
  if (found.timing_ms.empty()) throw InputError(input.path + ": no point, must have some");
  const double total = searching.done(std::to_string(found.objects.size()) + " objects");
  found.timing_ms.emplace_back("load", input.loading_ms);
  found.timing_ms.emplace_back("total", total);
  return found;
}

int run(int argc, char** argv) {
  SceneToolOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (options.output) checkCloudExtension(*options.output);
  const Console console(options.common.quiet);
  const InputShape input = loadInput(console, options.input, options.common);
  if (input.shape.mesh) throw InputError(options.input + ": is a mesh, must be a cloud as a sensor sees it");
  const SceneAnalysis scene = analyse(console, input, options);
  std::fputs(tableOf(scene, input.shift()).c_str(), stdout);
  if (options.common.json_path) writeText(*options.common.json_path, jsonText(describeScene(input, scene)) + "\n");
  if (options.output)
    saveCloud(*options.output, completedScene(input, scene), input.shape.sensor_origin, input.shape.sensor_orientation);
  if (options.png_path) {
    Step drawing(console, "Drawing " + *options.png_path);
    drawScene(input, scene, *options.png_path);
    drawing.done();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
