/// The canonical frame of a cloud by its symmetry, or the transform that brings it to another one; completion.
#include <pcl/common/io.h>
#include <pcl/console/print.h>
#include <pcl/conversions.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cloud_fields.h"
#include "console.h"
#include "options.h"
#include "pcl_symmetry/completion.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/registration/symmetry_registration.h"
#include "pcl_symmetry/symmetry_alignment.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"
#include "shape_input.h"
#include "shape_output.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct AlignOptions {
  std::string input;
  std::optional<std::string> output, target;
  bool complete = false;
  int mesh_points = 10'000;
  CommonOptions common;
};

CommandLine commandLine(AlignOptions& options) {
  CommandLine line(
      "pcl_symmetry_align",
      "Turns a cloud into the frame of its symmetry: center to the origin, axes to x, y and z, best first. "
      "With -target, brings it to another cloud instead, from any pose.",
      "pcl_symmetry_align scan.pcd aligned.pcd -target model.ply -json pose.json");
  line.positional("input", options.input, ".pcd, .ply, .obj, .stl or .off")
      .positional("output", options.output, ".pcd or .ply: the cloud after the transform")
      .text("target", "FILE", options.target, "cloud or mesh that the input is brought to")
      .flag(
          "complete", options.complete,
          "reflect the cloud across its best plane of symmetry, except into space that was seen to be empty; the field "
          "reflected_of tells added points")
      .number("points", options.mesh_points, Range::closed(100, 10'000'000), "points spread over a mesh")
      .common(options.common, kAllCommonFlags);
  return line;
}

nlohmann::json toJson(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

nlohmann::json toJson(const Eigen::Isometry3d& transform) {
  nlohmann::json numbers = nlohmann::json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) numbers.push_back(transform.matrix()(row, column));
  return numbers;
}

nlohmann::json toJson(const std::vector<std::pair<std::string, double>>& timing_ms) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [stage, ms] : timing_ms) json[stage] = ms;
  return json;
}

/// A cloud as it is analysed, and as it is written.
struct Input {
  std::string path;
  Shape shape;
  pcl::PointCloud<pcl::PointXYZ>::Ptr points;
};

Input load(const Console& console, const std::string& path, const AlignOptions& options) {
  Step loading(console, "Loading " + path);
  Input input{path, loadShape(path), nullptr};
  input.points = input.shape.points;
  if (input.shape.mesh) {
    input.points = sampleMesh(*input.shape.mesh, options.mesh_points, options.common.seed + 1);
    pcl::toPCLPointCloud2(*input.points, input.shape.cloud);
  }
  loading.done(std::to_string(input.points->size()) + " points");
  return input;
}

SymmetryFrame computeFrame(const Console& console, const Input& input, const CommonOptions& common) {
  Step step(console, "Searching the frame");
  FrameOptions frame_options;
  frame_options.edt.num_cells = common.grid;
  frame_options.seed = common.seed + 1;
  frame_options.num_threads = frame_options.edt.num_threads = common.threads;
  SymmetryAlignment<pcl::PointXYZ> alignment;
  try {
    alignment.setOptions(frame_options);
    alignment.setViewpoint(common.viewpoint);
    alignment.setInputCloud(input.points);
    const SymmetryFrame frame = alignment.compute();
    if (!alignment.getReason().empty()) throw InputError(input.path + ": " + alignment.getReason());
    step.done(alignment.usedViewpoint() ? "seen from one side" : "");
    return frame;
  } catch (const pcl::BadArgumentException& error) {
    throw InputError(input.path + ": " + error.detailedMessage());
  }
}

/// The best plane of symmetry; of a body of revolution the one that takes the side that was seen to the other.
ReflectionPlane bestPlane(const Console& console, const Input& input, const CommonOptions& common) {
  Step step(console, "Searching planes");
  DetectionOptions detection;
  detection.edt.num_cells = common.grid;
  detection.seed = common.seed + 1;
  detection.num_threads = detection.edt.num_threads = common.threads;
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  std::vector<SymmetryPlane> planes;
  try {
    refinement.setOptions(detection);
    refinement.setViewpoint(common.viewpoint);
    refinement.setInputCloud(input.points);
    planes = refinement.compute();
    if (!refinement.getReason().empty()) throw InputError(input.path + ": " + refinement.getReason());
  } catch (const pcl::BadArgumentException& error) {
    throw InputError(input.path + ": " + error.detailedMessage());
  }
  if (!refinement.getAxes().empty()) {
    const SymmetryAxis& axis = refinement.getAxes().front();
    const Eigen::Vector3d scanner = common.viewpoint.mode == Viewpoint::Mode::Given
                                        ? common.viewpoint.position
                                        : input.shape.sensor_origin.head<3>().cast<double>().eval();
    const Eigen::Vector3d to_scanner = scanner - axis.point;
    const Eigen::Vector3d across = to_scanner - axis.direction.dot(to_scanner) * axis.direction;
    const Eigen::Vector3d normal =
        across.norm() > 1e-6 * to_scanner.norm() ? across.normalized() : axis.direction.unitOrthogonal();
    step.done("axis of revolution");
    return ReflectionPlane(normal, normal.dot(axis.point));
  }
  if (planes.empty()) throw InputError(input.path + ": has no plane of symmetry to complete it across");
  step.done("confidence " + std::to_string(std::lround(100.0 * planes.front().confidence)) + " %");
  return planes.front();
}

/// Adds what its symmetry shows of the side that was not seen.
void complete(const Console& console, Input& input, const CommonOptions& common) {
  const ReflectionPlane plane = bestPlane(console, input, common);
  Step step(console, "Completing");
  CompletionOptions options;
  options.num_threads = common.threads;
  const auto completed = completeBySymmetry(*input.points, plane, options, common.viewpoint);
  const std::size_t size = input.points->size();
  input.shape.cloud = appendCopies(input.shape.cloud, completed.sources, "reflected_of");
  movePoints(input.shape.cloud, plane.reflection(), size);
  step.done(std::to_string(completed.added.size()) + " points added");
}

struct Registered {
  Eigen::Isometry3d T_target_source;
  bool converged;
  nlohmann::json json;
};

Registered registerTo(const Console& console, const Input& input, const Input& target, const CommonOptions& common) {
  Step step(console, "Registering");
  SymmetryRegistration<pcl::PointXYZ, pcl::PointXYZ, double> registration;
  registration.setSourceViewpoint(common.viewpoint);
  registration.setRandomSeed(common.seed + 1);
  registration.setNumberOfThreads(common.threads);
  registration.setInputSource(input.points);
  registration.setInputTarget(target.points);
  pcl::PointCloud<pcl::PointXYZ> aligned;
  registration.align(aligned);
  Registered result{Eigen::Isometry3d(registration.getFinalTransformation()), registration.hasConverged(), {}};
  result.json = {{"transform", toJson(result.T_target_source)},  {"converged", result.converged},
                 {"fitness", registration.getFitnessScore()},    {"support", registration.getScore().support},
                 {"conflict", registration.getScore().conflict}, {"timing_ms", toJson(registration.getTiming())}};
  step.done(result.converged ? "converged" : "nothing fits");
  return result;
}

nlohmann::json describe(const SymmetryFrame& frame) {
  nlohmann::json json{{"center", toJson(frame.center)},
                      {"axes", nlohmann::json::array()},
                      {"scores", toJson(frame.scores)},
                      {"revolution_axis", frame.revolution_axis},
                      {"transform", toJson(frame.T_canonical_input)},
                      {"timing_ms", toJson(frame.timing_ms)}};
  for (int k = 0; k < 3; ++k) json["axes"].push_back(toJson(frame.axes.col(k)));
  json["equivalent"] = nlohmann::json::array();
  for (const Eigen::Isometry3d& T_canonical_input : frame.equivalent)
    json["equivalent"].push_back(toJson(T_canonical_input));
  return json;
}

void print(const SymmetryFrame& frame) {
  std::printf("center %.6g %.6g %.6g\n", frame.center.x(), frame.center.y(), frame.center.z());
  for (int k = 0; k < 3; ++k)
    std::printf("axis %d %9.6f %9.6f %9.6f  score %.3f%s\n", k + 1, frame.axes(0, k), frame.axes(1, k),
                frame.axes(2, k), frame.scores[k], frame.revolution_axis == k ? "  axis of revolution" : "");
}

void save(const Console& console, Input& input, const Eigen::Isometry3d& motion, const std::string& path) {
  Step step(console, "Saving " + path);
  movePoints(input.shape.cloud, Eigen::Affine3d(motion.matrix()));
  Eigen::Vector4f origin = input.shape.sensor_origin;
  origin.head<3>() = (motion * origin.head<3>().cast<double>()).cast<float>();
  const Eigen::Quaternionf orientation(
      Eigen::Quaterniond(motion.linear() * input.shape.sensor_orientation.cast<double>()).cast<float>());
  saveCloud(path, input.shape.cloud, origin, orientation);
  step.done(std::to_string(static_cast<std::size_t>(input.shape.cloud.width) * input.shape.cloud.height) + " points");
}

int run(int argc, char** argv) {
  AlignOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (options.output) checkCloudExtension(*options.output);
  const Console console(options.common.quiet);
  // What the classes have to say is said here, in one line.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);

  Input input = load(console, options.input, options);
  std::optional<SymmetryFrame> frame;
  if (!options.target) frame = computeFrame(console, input, options.common);
  Eigen::Isometry3d motion;
  nlohmann::json json;
  if (options.target) {
    const Registered registered = registerTo(console, input, load(console, *options.target, options), options.common);
    json = registered.json;
    motion = registered.T_target_source;
    if (!registered.converged) {
      if (options.common.json_path) writeText(*options.common.json_path, json.dump(2) + "\n");
      throw InputError(options.input + ": does not fit " + *options.target + " in any pose");
    }
    for (int row = 0; row < 4; ++row)
      std::printf("%12.6f %12.6f %12.6f %12.6g\n", motion(row, 0), motion(row, 1), motion(row, 2), motion(row, 3));
  } else {
    json = describe(*frame);
    motion = frame->T_canonical_input;
    print(*frame);
  }
  if (options.complete) complete(console, input, options.common);
  if (options.output) save(console, input, motion, *options.output);
  if (options.common.json_path) writeText(*options.common.json_path, json.dump(2) + "\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
