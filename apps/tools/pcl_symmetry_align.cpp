/// The canonical frame of a cloud by its symmetry, or the transform that brings it to another one; completion.
#include <pcl/console/print.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/command_line.h"
#include "command_line/console.h"
#include "command_line/file_errors.h"
#include "command_line/run_on_files.h"
#include "command_line/run_tool.h"
#include "io/cloud_fields.h"
#include "io/exact_coordinates.h"
#include "io/input_shape.h"
#include "io/json_values.h"
#include "io/shape_output.h"
#include "io/turn_values.h"
#include "pcl_symmetry/completion.h"
#include "pcl_symmetry/symmetry_alignment.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "pcl_symmetry/symmetry_registration.h"
#include "pictures/scene_page.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct AlignOptions {
  BatchOptions batch;
  std::string input;
  std::optional<std::string> output, target, html_path;
  bool complete = false;
  CommonOptions common;
};

CommandLine commandLine(AlignOptions& options) {
  CommandLine line(
      "pcl_symmetry_align",
      "Turns a cloud into the frame of its symmetry: center to the origin, axes to x, y and z, best first. "
      "With -target, brings it to another cloud instead, from any pose.",
      "pcl_symmetry_align scan.pcd aligned.pcd -target model.ply -json pose.json");
  options.batch.outputs = {&options.output, &options.html_path};
  line.positional("input", options.input, kOneOrManyInputs)
      .positional("output", options.output, ".pcd or .ply: the cloud after the transform")
      .text("target", "FILE", options.target, "cloud or mesh that the input is brought to")
      .text("html", "FILE", options.html_path,
            "page that shows the input in the target, or its center and axes, for any browser, without network")
      .flag("complete", options.complete,
            "reflect the cloud across its best plane of symmetry, except into space that was seen to be empty; the "
            "field reflected_of of an added point is the index of its source, and -1 for all others")
      .common(options.common, kShapeFlags);
  options.batch.addTo(line);
  return line;
}

/// In the frame of the shifted points.
SymmetryFrame computeFrame(const Console& console, const InputShape& input, const CommonOptions& common) {
  Step step(console, "Searching the frame");
  FrameOptions options;
  common.applyTo(options);
  SymmetryAlignment<pcl::PointXYZ> alignment;
  return namingFile(input.path, [&] {
    alignment.setOptions(options);
    alignment.setViewpoint(shifted(common.viewpoint, input.shift()));
    alignment.setInputCloud(input.points);
    const SymmetryFrame frame = alignment.compute();
    if (!alignment.getReason().empty()) throw InputError(input.path + ": " + alignment.getReason());
    step.done(alignment.usedViewpoint() ? "seen from one side" : "");
    return frame;
  });
}

/// The plane through an axis of revolution that takes the side that was seen to the other.
ReflectionPlane planeThrough(const SymmetryAxis& axis, const Eigen::Vector3d& scanner) {
  // A scanner closer to the axis than this share of its distance tells no direction. chosen: far below what a scan
  // resolves; half and twice change no plane.
  constexpr double kLeastSine = 1e-6;
  const Eigen::Vector3d to_scanner = scanner - axis.point;
  const Eigen::Vector3d across = to_scanner - axis.direction.dot(to_scanner) * axis.direction;
  const Eigen::Vector3d normal =
      across.norm() > kLeastSine * to_scanner.norm() ? across.normalized() : axis.direction.unitOrthogonal();
  return ReflectionPlane(normal, normal.dot(axis.point));
}

/// The best plane of symmetry, or one through the axis of a body of revolution; in the frame of the shifted points.
ReflectionPlane bestPlane(const Console& console, const InputShape& input, const CommonOptions& common) {
  Step step(console, "Searching planes");
  DetectionOptions detection;
  common.applyTo(detection);
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  const std::vector<SymmetryPlane> planes = namingFile(input.path, [&] {
    refinement.setOptions(detection);
    refinement.setViewpoint(shifted(common.viewpoint, input.shift()));
    refinement.setInputCloud(input.points);
    std::vector<SymmetryPlane> found = refinement.compute();
    if (!refinement.getReason().empty()) throw InputError(input.path + ": " + refinement.getReason());
    return found;
  });
  if (!refinement.getAxes().empty()) {
    step.done("axis of revolution");
    return planeThrough(
        refinement.getAxes().front(),
        refinement.getUsedViewpoint().value_or(input.shape.points->sensor_origin_.head<3>().cast<double>().eval()));
  }
  if (planes.empty() && refinement.getBestPlane()) {
    step.done("no symmetry; the best plane is used");
    return *refinement.getBestPlane();
  }
  if (planes.empty()) throw InputError(input.path + ": has no plane of symmetry to complete it across");
  step.done("confidence " + std::to_string(std::lround(100.0 * planes.front().confidence)) + " %");
  return planes.front();
}

/// Adds to the fields what its symmetry shows of the side that was not seen.
void complete(const Console& console, const InputShape& input, const CommonOptions& common,
              pcl::PCLPointCloud2& fields) {
  const ReflectionPlane plane = bestPlane(console, input, common);
  Step step(console, "Completing");
  CompletionOptions options;
  options.num_threads = common.threads;
  const auto completed = completeBySymmetry(*input.points, plane, options, shifted(common.viewpoint, input.shift()));
  fields = appendCopies(fields, completed.sources, "reflected_of");
  movePoints(fields, shiftedBack(plane, input.shift()).reflection(), input.points->size());
  step.done(std::to_string(completed.added.size()) + " points added");
}

/// A motion of the input, between input frames, and what is reported about it.
struct Motion {
  Eigen::Isometry3d transform;
  bool converged = true;
  std::string text;
  nlohmann::json json;
  std::optional<PictureScene> scene;  ///< what a page shows of it, where one is wanted
};

/// The shape with the axes of its frame: the first red, the second green, the third blue.
PictureScene sceneOf(const InputShape& input, const SymmetryFrame& frame) {
  PictureScene scene;
  scene.points = input.points;
  scene.mesh = input.shape.mesh;
  PicturePanel panel;
  panel.label = "center and axes: 1 red, 2 green, 3 blue";
  panel.show_points = !scene.mesh;
  for (int k = 0; k < 3; ++k) panel.axes.push_back({frame.center, frame.axes.col(k), Eigen::Vector3d::Unit(k)});
  scene.panels = {panel};
  return scene;
}

/// The target, and the input where the motion brings it, in two colours.
PictureScene sceneOf(const InputShape& input, const InputShape& target, const Eigen::Isometry3d& T_target_input) {
  const pcl::PointCloud<pcl::PointXYZ>::Ptr both(new pcl::PointCloud<pcl::PointXYZ>(*target.points));
  for (const pcl::PointXYZ& point : *input.points) {
    const Eigen::Vector3d x = T_target_input * (point.getVector3fMap().cast<double>() + input.shift());
    both->emplace_back();
    both->back().getVector3fMap() = (x - target.shift()).cast<float>();
  }
  PictureScene scene;
  PicturePanel panel;
  panel.label = "target (1) and the input in it (2)";
  panel.segments.assign(target.points->size(), 0);
  panel.segments.resize(both->size(), 1);
  both->width = static_cast<std::uint32_t>(both->size());
  both->height = 1;
  scene.points = both;
  scene.panels = {panel};
  return scene;
}

Motion registerTo(const Console& console, const InputShape& input, const InputShape& target,
                  const CommonOptions& common) {
  Step step(console, "Registering");
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ, double> registration;
  registration.setSourceViewpoint(shifted(common.viewpoint, input.shift()));
  registration.setRandomSeed(common.librarySeed());
  registration.setNumberOfThreads(common.threads);
  registration.setInputSource(input.points);
  registration.setInputTarget(target.points);
  pcl::PointCloud<pcl::PointXYZ> aligned;
  registration.align(aligned);
  Motion result;
  result.transform =
      shiftedBack(Eigen::Isometry3d(registration.getFinalTransformation()), input.shift(), target.shift());
  result.converged = registration.hasConverged();
  result.json = {{"transform", rowMajor(result.transform)},      {"converged", result.converged},
                 {"fitness", registration.getFitnessScore()},    {"support", registration.getScore().support},
                 {"conflict", registration.getScore().conflict}, {"timing_ms", timingJson(registration.getTiming())}};
  step.done(result.converged ? "converged" : "nothing fits");
  return result;
}

std::string linesOf(const Eigen::Isometry3d& motion, int digits) {
  std::string lines;
  for (int row = 0; row < 4; ++row) {
    char text[96];
    std::snprintf(text, sizeof(text), "%12.6f %12.6f %12.6f %12.*g\n", motion(row, 0), motion(row, 1), motion(row, 2),
                  digits, motion(row, 3));
    lines += text;
  }
  return lines;
}

nlohmann::json describe(const SymmetryFrame& frame, const Eigen::Vector3d& shift) {
  const auto absolute = [&](const Eigen::Isometry3d& T_canonical_input) {
    return rowMajor(shiftedBack(T_canonical_input, shift, Eigen::Vector3d::Zero()));
  };
  nlohmann::json json{{"center", numbersOf(shiftedBack(frame.center, shift))},
                      {"axes", nlohmann::json::array()},
                      {"scores", numbersOf(frame.scores)},
                      {"revolution_axis", frame.revolution_axis},
                      {"transform", absolute(frame.T_canonical_input)},
                      {"timing_ms", timingJson(frame.timing_ms)}};
  for (int k = 0; k < 3; ++k) json["axes"].push_back(numbersOf(frame.axes.col(k)));
  json["equivalent"] = nlohmann::json::array();
  for (const Eigen::Isometry3d& T_canonical_input : frame.equivalent)
    json["equivalent"].push_back(absolute(T_canonical_input));
  json["turns"] = turnsJson(frame.turns, shift);
  json["probable"] = nlohmann::json::array();
  for (const ProbableFrame& other : frame.probable) {
    nlohmann::json axes = nlohmann::json::array();
    for (int k = 0; k < 3; ++k) axes.push_back(numbersOf(other.axes.col(k)));
    json["probable"].push_back({{"center", numbersOf(shiftedBack(other.center, shift))},
                                {"axes", axes},
                                {"revolution_axis", other.revolution_axis},
                                {"probability", other.probability}});
  }
  return json;
}

std::string linesOf(const SymmetryFrame& frame, const Eigen::Vector3d& shift) {
  std::string lines = "center " + spelled(shiftedBack(frame.center, shift), lengthDigits(shift)) + "\n";
  for (int k = 0; k < 3; ++k) {
    char text[128];
    std::snprintf(text, sizeof(text), "axis %d %9.6f %9.6f %9.6f  score %.3f%s\n", k + 1, frame.axes(0, k),
                  frame.axes(1, k), frame.axes(2, k), frame.scores[k],
                  frame.revolution_axis == k ? "  axis of revolution" : "");
    lines += text;
  }
  for (const SymmetryTurn& turn : frame.turns)
    if (turn.confidence >= DetectionOptions().min_confidence) lines += lineOf(turn, shift);
  double others = 0.0;
  for (std::size_t i = 1; i < frame.probable.size(); ++i) others += frame.probable[i].probability;
  char text[96];
  if (!frame.probable.empty()) {
    std::snprintf(text, sizeof(text), "probability of these axes %.2f, of %zu others %.2f\n",
                  frame.probable.front().probability, frame.probable.size() - 1, others);
    lines += text;
  }
  return lines;
}

Motion toOwnFrame(const Console& console, const InputShape& input, const AlignOptions& options,
                  const CommonOptions& common) {
  const SymmetryFrame frame = computeFrame(console, input, common);
  Motion motion{shiftedBack(frame.T_canonical_input, input.shift(), Eigen::Vector3d::Zero()),
                true,
                linesOf(frame, input.shift()),
                describe(frame, input.shift()),
                {}};
  if (options.html_path) motion.scene = sceneOf(input, frame);
  return motion;
}

Motion toTarget(const Console& console, const InputShape& input, const AlignOptions& options,
                const CommonOptions& common) {
  const InputShape target = loadInput(console, *options.target, common);
  Motion motion = registerTo(console, input, target, common);
  if (options.html_path) motion.scene = sceneOf(input, target, motion.transform);
  if (motion.converged)
    motion.text = linesOf(motion.transform, std::max(lengthDigits(input.shift()), lengthDigits(target.shift())));
  return motion;
}

/// The transform, row by row.
std::vector<std::vector<nlohmann::json>> rowsOf(const Motion& motion) {
  std::vector<nlohmann::json> row{motion.converged};
  for (const double value : rowMajor(motion.transform)) row.emplace_back(value);
  return {row};
}

void save(const Console& console, const Shape& shape, pcl::PCLPointCloud2 fields, const Eigen::Isometry3d& motion,
          const std::string& path) {
  Step step(console, "Saving " + path);
  movePoints(fields, Eigen::Affine3d(motion.matrix()));
  Eigen::Vector4f origin = shape.sensor_origin;
  origin.head<3>() = (motion * origin.head<3>().cast<double>()).cast<float>();
  const Eigen::Quaternionf orientation(
      Eigen::Quaterniond(motion.linear() * shape.sensor_orientation.cast<double>()).cast<float>());
  saveCloud(path, fields, origin, orientation);
  step.done(std::to_string(static_cast<std::size_t>(fields.width) * fields.height) + " points");
}

void analyse(const AlignOptions& options, FileJob& job) {
  const Console& console = job.console();
  CommonOptions common = options.common;
  common.threads = job.numThreads();
  const InputShape input = loadInput(console, job.path(), common);
  Motion motion =
      options.target ? toTarget(console, input, options, common) : toOwnFrame(console, input, options, common);
  job.report({motion.text, motion.json, rowsOf(motion)});
  if (!motion.converged) throw InputError(job.path() + ": does not fit " + *options.target + " in any pose");
  if (options.html_path) writePage(*motion.scene, {job.path(), motion.text}, job.output(*options.html_path));
  pcl::PCLPointCloud2 fields = input.fields();
  if (options.complete) complete(console, input, common, fields);
  if (options.output) save(console, input.shape, std::move(fields), motion.transform, job.output(*options.output));
}

int run(int argc, char** argv) {
  AlignOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (options.output) checkCloudExtension(*options.output);
  // What the classes have to say is said here, in one line.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  options.batch.inputs = {options.input};
  std::vector<std::string> columns{"converged"};
  for (const char row : {'0', '1', '2', '3'})
    for (const char column : {'0', '1', '2', '3'}) columns.push_back(std::string("t") + row + column);
  return runOnFiles(options.batch, options.common, columns, [&](FileJob& job) { analyse(options, job); });
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
