/// Symmetries, diameter and extent of models, as models_info.json of the BOP pose benchmark has them.
#include <algorithm>
#include <boost/filesystem/path.hpp>
#include <cctype>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/command_line/file_errors.h"
#include "common/command_line/run_tool.h"
#include "common/files/json_values.h"
#include "common/shape_input/exact_coordinates.h"
#include "common/shape_input/shape_input.h"
#include "common/shape_output/shape_output.h"
#include "core/neighbours/diameter.h"
#include "pcl_symmetry/object_symmetries.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct BopOptions {
  std::vector<std::string> inputs;
  ObjectSymmetryOptions symmetries;
  CommonOptions common;
};

CommandLine commandLine(BopOptions& options) {
  CommandLine line("pcl_symmetry_bop",
                   "Finds the rotations that map models onto themselves, and writes them with diameter and extent as "
                   "models_info.json of the BOP pose benchmark, in the unit of the input (BOP's is the millimetre).",
                   "pcl_symmetry_bop models/obj_*.ply -json models/models_info.json");
  line.positionals("input", options.inputs,
                   std::string(kShapeFiles) +
                       "; obj_000012.ply is model 12, a name without a number takes the first "
                       "free one")
      .number("feature", options.symmetries.max_feature, Range::closed(0, 1),
              "share of the surface, as of plugs and notches, that a symmetry may map off the surface")
      .number("tolerance", options.symmetries.tolerance, Range::upTo(0, 0.1),
              "how far a symmetric surface may be off, share of the greatest distance between two points")
      .number("absolute_tolerance", options.symmetries.absolute_tolerance, Range::atLeast(0),
              "the same in the unit of the input; 0: the share decides")
      .number("min_confidence", options.symmetries.min_confidence, Range::closed(0, 1),
              "least probability of rotations that are called symmetries")
      .common(options.common, kMeshPoints | kJson | kSeed | kThreads | kGrid | kQuiet);
  return line;
}

/// The number that the name of a file ends in; empty where it ends in none.
std::string numberOf(const std::string& path) {
  const std::string stem = boost::filesystem::path(path).stem().string();
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const auto digits = std::find_if_not(stem.rbegin(), stem.rend(), is_digit).base();
  const auto number = std::find_if(digits, stem.end(), [](char c) { return c != '0'; });
  return digits != stem.end() && number == stem.end() ? "0" : std::string(number, stem.end());
}

/// The number of each file; where there is none the first from 1 on that is free.
/// \throws UsageError where two files have one number.
std::vector<std::string> keysOf(const std::vector<std::string>& paths) {
  std::map<std::string, std::string> path_of;
  std::vector<std::string> keys;
  for (const std::string& path : paths) {
    keys.push_back(numberOf(path));
    if (keys.back().empty()) continue;
    const auto [entry, is_new] = path_of.insert({keys.back(), path});
    if (!is_new) throw UsageError(path + " and " + entry->second + " are both model " + keys.back());
  }
  int free = 1;
  for (std::string& key : keys) {
    if (!key.empty()) continue;
    while (path_of.count(std::to_string(free)) > 0) ++free;
    key = std::to_string(free++);
  }
  return keys;
}

/// What models_info.json says of a model.
struct ModelInfo {
  std::string key, file;
  Eigen::Vector3d low, size;  ///< of the bounding box, input frame
  double diameter;
  int digits;                   ///< significant ones of lengths that are printed
  ObjectSymmetries symmetries;  ///< input frame
};

Points finitePoints(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  Points points(3, static_cast<Eigen::Index>(cloud.size()));
  Eigen::Index size = 0;
  for (const pcl::PointXYZ& point : cloud)
    if (point.getVector3fMap().allFinite()) points.col(size++) = point.getVector3fMap();
  points.conservativeResize(3, size);
  return points;
}

void shiftBack(ObjectSymmetries& symmetries, const Eigen::Vector3d& shift) {
  if (shift.isZero(0.0)) return;
  symmetries.center += shift;
  for (Eigen::Isometry3d& symmetry : symmetries.discrete) symmetry = shiftedBack(symmetry, shift, shift);
  for (ContinuousSymmetry& symmetry : symmetries.continuous) symmetry.offset += shift;
}

ModelInfo analyse(const Console& console, const std::string& path, const BopOptions& options) {
  Step loading(console, "Loading " + path);
  const Shape shape = loadShape(path);
  const Points vertices = finitePoints(*shape.points);
  if (vertices.cols() == 0) throw InputError(path + ": has no finite points");
  loading.done(std::to_string(vertices.cols()) + (shape.mesh ? " vertices" : " points"));
  ModelInfo info;
  info.file = path;
  info.digits = lengthDigits(shape.shift);
  info.low = vertices.rowwise().minCoeff().cast<double>();
  info.size = vertices.rowwise().maxCoeff().cast<double>() - info.low;
  info.low = shiftedBack(info.low, shape.shift);
  info.diameter = diameter(vertices);
  Step searching(console, "Searching rotations");
  info.symmetries = namingFile(path, [&] {
    return shape.mesh ? detectObjectSymmetries(*shape.mesh, options.symmetries, options.common.mesh_points)
                      : detectObjectSymmetries(*shape.points, options.symmetries);
  });
  if (!info.symmetries.reason.empty()) throw InputError(path + ": " + info.symmetries.reason);
  shiftBack(info.symmetries, shape.shift);
  searching.done(info.symmetries.name());
  return info;
}

nlohmann::ordered_json toJson(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

nlohmann::ordered_json toJson(const ModelInfo& info) {
  nlohmann::ordered_json json{{"diameter", info.diameter}, {"min_x", info.low.x()},   {"min_y", info.low.y()},
                              {"min_z", info.low.z()},     {"size_x", info.size.x()}, {"size_y", info.size.y()},
                              {"size_z", info.size.z()}};
  for (const Eigen::Isometry3d& symmetry : info.symmetries.discrete) {
    json["symmetries_discrete"].push_back(rowMajor(symmetry));
  }
  for (const ContinuousSymmetry& symmetry : info.symmetries.continuous)
    json["symmetries_continuous"].push_back({{"axis", toJson(symmetry.axis)}, {"offset", toJson(symmetry.offset)}});
  return json;
}

/// By number, a line each, as the benchmark's own files are.
std::string modelsInfo(std::vector<ModelInfo> infos) {
  std::stable_sort(infos.begin(), infos.end(), [](const ModelInfo& a, const ModelInfo& b) {
    return a.key.size() != b.key.size() ? a.key.size() < b.key.size() : a.key < b.key;
  });
  std::string text;
  for (const ModelInfo& info : infos)
    text += (text.empty() ? "{\n  \"" : ",\n  \"") + info.key + "\": " + toJson(info).dump();
  return text + "\n}\n";
}

void printInfo(const ModelInfo& info) {
  const ObjectSymmetries& found = info.symmetries;
  std::printf("model %s  %s  group %s, %zu discrete, %zu continuous, confidence %.3f\n", info.key.c_str(),
              info.file.c_str(), found.name().c_str(), found.discrete.size(), found.continuous.size(),
              found.confidence);
  std::printf("  diameter %.6g  size %.6g x %.6g x %.6g\n", info.diameter, info.size.x(), info.size.y(), info.size.z());
  const auto print_axis = [&](const Eigen::Vector3d& direction, const std::string& turns) {
    std::printf("  axis %9.6f %9.6f %9.6f through %s  %s\n", direction.x(), direction.y(), direction.z(),
                spelled(found.center, info.digits).c_str(), turns.c_str());
  };
  for (const ContinuousSymmetry& symmetry : found.continuous) print_axis(symmetry.axis, "any angle");
  std::vector<Eigen::Matrix3d> rotations;
  for (const Eigen::Isometry3d& symmetry : found.discrete) rotations.push_back(symmetry.linear());
  for (const RotationAxis& axis : axesOf(rotations)) print_axis(axis.direction, "fold " + std::to_string(axis.order));
}

int run(int argc, char** argv) {
  BopOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  const std::vector<std::string> keys = keysOf(options.inputs);
  options.symmetries.num_cells = options.common.grid;
  options.symmetries.max_points = std::max(options.symmetries.max_points, options.common.mesh_points);
  options.symmetries.seed = options.common.librarySeed();
  options.symmetries.num_threads = options.common.threads;
  const Console console(options.common.quiet);
  std::vector<ModelInfo> infos;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    try {
      infos.push_back(analyse(console, options.inputs[i], options));
      infos.back().key = keys[i];
      printInfo(infos.back());
    } catch (const InputError& error) {
      console.error(error.what());
    }
  }
  if (infos.empty()) return 1;
  const bool all_done = infos.size() == keys.size();
  if (options.common.json_path) writeText(*options.common.json_path, modelsInfo(std::move(infos)));
  return all_done ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
