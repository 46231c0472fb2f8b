/// The objects of one frame of a sensor and their symmetries: a table, JSON, the completed scene, a picture, a page.
#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "command_line/command_line.h"
#include "command_line/console.h"
#include "command_line/flag_values.h"
#include "command_line/run_on_files.h"
#include "command_line/tool_errors.h"
#include "io/answers.h"
#include "io/exact_coordinates.h"
#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/load_module.h"
#include "io/shape_output.h"
#include "pcl_symmetry/symmetry_scene.h"
#include "pictures/drawing.h"
#include "pictures/scene_page.h"
#include "scene/scene_report.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct SceneToolOptions {
  BatchOptions batch;
  std::string input;
  std::optional<std::string> output, database_path, png_path, html_path;
  bool no_frames = false, no_completion = false, no_separation = false, explain = false;
  std::optional<Eigen::Vector4d> ground;
  std::optional<std::string> intrinsics;
  double depth_scale = 1000.0;
  SceneOptions scene;
  CommonOptions common;
};

CommandLine commandLine(SceneToolOptions& o) {
  CommandLine line(
      "pcl_symmetry_scene",
      "Finds the objects of a frame of a depth camera or scanner, and their symmetries. A cloud of one object alone "
      "would be taken apart: pcl_symmetry_planes takes it as a whole.",
      "pcl_symmetry_scene table.pcd completed.pcd -json objects.json -png objects.png");
  o.batch.outputs = {&o.output, &o.png_path, &o.html_path};
  line.positional("input", o.input,
                  ".pcd or .ply: organized, or with the viewpoint of the sensor; .png: a depth image of 16 bits, with "
                  "-intrinsics; - for standard input, or many: a folder, a "
                  "pattern in quotes, a list @FILE")
      .positional(
          "output", o.output,
          "completed scene, .pcd or .ply, with the fields object (-1 = supporting plane, 0 = none) and completed")
      .text("database", "FILE", o.database_path, "names objects by the models of this file of pcl_symmetry_database")
      .picture("png", o.png_path, "picture: the scene, and each object with what its symmetry adds")
      .page("html", o.html_path, "page that shows the scene, its objects, planes and axes in any browser")
      .text("intrinsics", "FX,FY,CX,CY", o.intrinsics, "of the camera of a depth image, pixels")
      .number("depth_scale", o.depth_scale, Range::above(0), "values of a depth image for each unit of length")
      .plane("ground", o.ground,
             "what the objects stand on, a x + b y + c z + d = 0, in place of supporting planes that are searched for")
      .number("max_range", o.scene.max_range, Range::atLeast(0),
              "points farther from the sensor are left out, input units; 0 = no limit")
      .number("plane_distance", o.scene.plane_distance, Range::atLeast(0),
              "distance of points that belong to a supporting plane, input units; 0 = from the points")
      .number("cluster_distance", o.scene.cluster_distance, Range::atLeast(0),
              "distance between points of one object, input units; 0 = from the points")
      .number("min_points", o.scene.min_points, Range::closed(20, 1'000'000'000), "least number of points of an object")
      .number("max_points", o.scene.max_points, Range::closed(100, 1'000'000'000),
              "points of an object that are analyzed")
      .number("accept", o.scene.recognition.min_confidence, Range::closed(0, 1),
              "with -database: least confidence of a name that is accepted")
      .number("min_confidence", o.scene.detection.min_confidence, Range::closed(0, 1),
              "least probability of a plane that is called a symmetry")
      .flag("explain", o.explain, "also print why each plane, axis and center of the objects has its confidence")
      .flag("no_separation", o.no_separation, "leaves objects that touch together")
      .flag("no_frames", o.no_frames, "leaves the frames of the objects out")
      .flag("no_completion", o.no_completion, "leaves the completion of the objects out")
      .common(o.common, kAnalysisFlags);
  o.batch.addTo(line);
  return line;
}

SymmetryScene makeScene(const SceneToolOptions& options, const CommonOptions& common,
                        const std::shared_ptr<const SymmetryDatabase>& database) {
  SymmetryScene scene;
  SceneOptions used = options.scene;
  used.detection.min_possible = std::min(used.detection.min_possible, used.detection.min_confidence);
  common.applyTo(used.detection);
  common.applyTo(used.frame);
  used.num_threads = used.completion.num_threads = used.recognition.num_threads = common.threads;
  used.frames = !options.no_frames;
  used.complete = !options.no_completion;
  used.separate = !options.no_separation;
  scene.setOptions(used);
  if (database) scene.setDatabase(database);
  return scene;
}

/// \return null if no database is named.
std::shared_ptr<const SymmetryDatabase> openDatabase(const SceneToolOptions& options) {
  if (!options.database_path) return nullptr;
  checkReadableFile(*options.database_path);
  DatabaseOptions database;
  database.num_threads = options.common.threads;
  return namingFile(*options.database_path,
                    [&] { return std::make_shared<const SymmetryDatabase>(*options.database_path, database); });
}

/// The points of a depth image, in the frame of its camera: x to the right, y down, z forward.
InputShape loadDepth(const Console& console, const std::string& path, const SceneToolOptions& options) {
  if (!options.intrinsics) throw UsageError(path + ": a depth image needs -intrinsics FX,FY,CX,CY of its camera");
  const std::string& given = *options.intrinsics;
  const std::vector<double> k = parseNumbers("-intrinsics", given);
  if (k.size() != 4 || !(k[0] > 0.0 && k[1] > 0.0))
    rejectValue("-intrinsics", given, "must be FX,FY,CX,CY of the camera of " + path + ", FX and FY > 0");
  checkReadableFile(path);
  Step loading(console, "Loading " + path);
  InputShape input;
  input.path = path;
  input.points = input.shape.points = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  functionOf<decltype(decodeDepth)>(kDrawingModule, "decodeDepth")(path, *input.points);
  for (pcl::PointXYZ& p : *input.points) {
    const double z = p.z > 0.0F ? p.z / options.depth_scale : std::nan("");
    p.getVector3fMap() = Eigen::Vector3d((p.x - k[2]) / k[0] * z, (p.y - k[3]) / k[1] * z, z).cast<float>();
  }
  input.points->is_dense = false;
  input.shape.cloud = toFields(*input.points, input.shift());
  input.loading_ms = loading.done(counted(finitePoints(*input.points).cols(), "point"));
  return input;
}

InputShape loadFrame(const Console& console, const std::string& path, const CommonOptions& common) {
  InputShape input = loadInput(console, path, common);
  if (input.shape.mesh) throw InputError(path + ": is a mesh, must be a cloud as a sensor sees it");
  return input;
}

SceneAnalysis analyze(const Console& console, SymmetryScene& scene, const InputShape& input,
                      const SceneToolOptions& options) {
  scene.setViewpoint(shifted(options.common.viewpoint, input.shift()));
  if (options.ground) scene.setGround(shifted(*options.ground, input.shift()));
  scene.setInputCloud(input.points);
  Step searching(console, "Searching objects");
  SceneAnalysis found;
  namingFile(input.path, [&] { found = scene.compute(); });
  if (!found.reason.empty()) throw InputError(input.path + ": input cloud: " + found.reason);
  const double total = searching.done(counted(found.objects.size(), "object"));
  found.timing_ms.emplace_back("load", input.loading_ms);
  found.timing_ms.emplace_back("total", total);
  if (!found.alone.empty())
    console.warn(input.path + ": " + found.alone + "; if this is one object, pcl_symmetry_planes takes it as a whole");
  return found;
}

void analyze(const SceneToolOptions& options, const std::shared_ptr<const SymmetryDatabase>& database, FileJob& job) {
  const bool is_depth = boost::algorithm::iends_with(job.path(), ".png");
  if (options.intrinsics && !is_depth) throw InputError(job.path() + ": is no depth image, -intrinsics needs a .png");
  const InputShape input =
      is_depth ? loadDepth(job.console(), job.path(), options) : loadFrame(job.console(), job.path(), job.common());
  SymmetryScene searched = makeScene(options, job.common(), database);
  const SceneAnalysis scene = analyze(job.console(), searched, input, options);
  std::string table = tableOf(scene, input.shift());
  for (std::size_t k = 0; options.explain && k < scene.objects.size(); ++k)
    table += formatted("object %zu\n", k + 1) + explained(scene.objects[k]);
  job.report({table, describeScene(input, scene), rowsOf(scene, input.shift())});
  if (options.output)
    saveCloud(job.output(*options.output), completedScene(input, scene), input.shape.sensor_origin,
              input.shape.sensor_orientation);
  if (options.png_path) {
    const std::string picture = job.output(*options.png_path);
    Step drawing(job.console(), "Drawing " + picture);
    drawScene(input, scene, picture);
    drawing.done();
  }
  if (options.html_path)
    writePage(selectableObjects(input, scene), {job.path(), table, cameraPicture(input)},
              job.output(*options.html_path));
}

int run(int argc, char** argv) {
  SceneToolOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  line.goWith("-intrinsics", options.intrinsics.has_value(), {"depth_scale"});
  line.goWith("-database", options.database_path.has_value(), {"accept"});
  if (options.output) checkCloudExtension(*options.output);
  const std::shared_ptr<const SymmetryDatabase> database = openDatabase(options);
  options.batch.inputs = {options.input};
  return runOnFiles(options.batch, options.common, {"object", "points", "found", "model", "x", "y", "z"},
                    [&](FileJob& job) { analyze(options, database, job); });
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
