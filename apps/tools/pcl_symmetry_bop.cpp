/// Symmetries, diameter and extent of models, as in models_info.json of the BOP pose benchmark.
#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cctype>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bop/model_analysis.h"
#include "bop/models_info.h"
#include "command_line/command_line.h"
#include "command_line/console.h"
#include "command_line/run_on_files.h"
#include "command_line/tool_errors.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "io/answers.h"
#include "io/shape_input.h"
#include "io/shape_output.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

using GivenSymmetries = std::map<std::string, ListedSymmetries>;

struct BopOptions {
  std::vector<std::string> inputs;
  ModelOptions models;
  double sphere_angle = 15.0;  ///< degrees
  std::optional<std::string> check_path, report_path, dope_folder, isaac_path;
  CommonOptions common;
};

CommandLine commandLine(BopOptions& options) {
  CommandLine line("pcl_symmetry_bop",
                   "Finds the rotations that map models onto themselves, and writes them with diameter and extent as "
                   "models_info.json of the BOP pose benchmark, in the unit of the input (BOP's is the millimeter).",
                   "pcl_symmetry_bop models -json models/models_info.json");
  line.positionals("input", options.inputs,
                   std::string(kShapeFiles) +
                       ", or a folder of them; obj_000012.ply is model 12, a name without a number takes the first "
                       "free one")
      .number("feature", options.models.symmetries.max_feature, Range::closed(0, 1),
              "share of the surface, as of plugs and notches, that a symmetry may map off the surface")
      .number("tolerance", options.models.symmetries.tolerance, Range::upTo(0, 0.1),
              "how far a symmetric surface may be off, share of the greatest distance between two points")
      .number("absolute_tolerance", options.models.symmetries.absolute_tolerance, Range::atLeast(0),
              "the same in the unit of the input; 0: the share decides")
      .number("min_confidence", options.models.symmetries.min_confidence, Range::closed(0, 1),
              "least confidence of rotations that are called symmetries")
      .flag("color", options.models.use_colors,
            "only rotations that keep the colors of the vertices, or of the texture of a PLY file")
      .number("color_tolerance", options.models.color_tolerance, Range::above(0),
              "difference of colors that counts as none, in CIELAB")
      .number("sphere_angle", options.sphere_angle, Range::upTo(0, 180),
              "degrees within which the tilts that are written for a sphere reach any rotation")
      .flag("explain", options.models.explain,
            "tell the groups at half and twice the tolerance, and which rotations fail, by how much and where")
      .text("failures", "DIR", options.models.failures_folder,
            "write NAME_rejected_1.ply and so on: the surface, colored where a rotation fails")
      .text("check", "FILE", options.check_path,
            "compare with models_info.json, DOPE's model_info.json, or Isaac's symmetry_axes in YAML")
      .text("report", "FILE", options.report_path, "with -check: the comparison as JSON")
      .text("dope", "DIR", options.dope_folder, "write NAME/model_info.json for DOPE, for each model")
      .text("isaac", "FILE", options.isaac_path, "write symmetry_axes for Isaac ROS, a line for each model")
      .common(options.common, kMeshPoints | kJson | kSeed | kThreads | kGrid | kQuiet);
  return line;
}

struct ModelFile {
  std::string path;
  std::string key;  ///< number of the model
};

std::vector<std::string> shapesIn(const std::string& folder) {
  std::vector<std::string> all, numbered;
  for (const auto& entry : boost::filesystem::directory_iterator(folder)) {
    if (!hasShapeExtension(entry.path().string())) continue;
    all.push_back(entry.path().string());
    if (boost::algorithm::starts_with(entry.path().filename().string(), "obj_")) numbered.push_back(all.back());
  }
  if (all.empty()) throw InputError(folder + ": holds no " + kShapeFilesOfFolders + " file");
  std::vector<std::string>& chosen = numbered.empty() ? all : numbered;
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// The number at the end of the name of a file; empty if there is none.
std::string numberOf(const std::string& path) {
  const std::string stem = boost::filesystem::path(path).stem().string();
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const auto digits = std::find_if_not(stem.rbegin(), stem.rend(), is_digit).base();
  const auto number = std::find_if(digits, stem.end(), [](char c) { return c != '0'; });
  return digits != stem.end() && number == stem.end() ? "0" : std::string(number, stem.end());
}

/// Files as given; from a folder, the files obj_* that hold shapes, or all shapes if none has such a name, sorted by
/// name.
/// \return each with the number at the end of its name; if there is none, the first free number from 1 on.
/// \throws UsageError if two files have the same number; InputError for a folder without a shape.
std::vector<ModelFile> modelFiles(const std::vector<std::string>& inputs) {
  std::vector<ModelFile> models;
  for (const std::string& input : inputs) {
    if (!boost::filesystem::is_directory(input)) {
      models.push_back({input, numberOf(input)});
      continue;
    }
    for (const std::string& path : shapesIn(input)) models.push_back({path, numberOf(path)});
  }
  std::map<std::string, std::string> path_of;
  for (const ModelFile& model : models) {
    if (model.key.empty()) continue;
    const auto [entry, is_new] = path_of.insert({model.key, model.path});
    if (!is_new) throw UsageError(model.path + " and " + entry->second + " are both model " + model.key);
  }
  int free = 1;
  for (ModelFile& model : models) {
    if (!model.key.empty()) continue;
    while (path_of.count(std::to_string(free)) > 0) ++free;
    model.key = std::to_string(free++);
  }
  return models;
}

GivenSymmetries readGiven(const std::string& path, std::size_t num_models) {
  const std::string ending = boost::filesystem::path(path).extension().string();
  GivenSymmetries given = ending == ".yaml" || ending == ".yml" ? readIsaacAxes(path) : readModelsInfo(path);
  if (given.count("") > 0 && num_models != 1)
    throw InputError(path + ": is a file of one model, there are " + std::to_string(num_models));
  return given;
}

std::optional<ListedSymmetries> givenFor(const GivenSymmetries& given, const std::string& key) {
  const auto entry = given.find(given.count("") > 0 ? "" : key);
  if (entry == given.end()) return std::nullopt;
  return entry->second;
}

/// The results of the models, in their order, and what went wrong.
struct Results {
  std::vector<ModelInfo> infos;
  std::vector<std::string> errors;
};

/// Analyzes one model at a time on each thread: memory grows with the threads, not with the models.
Results analyzeAll(const std::vector<ModelFile>& files, const BopOptions& options, const GivenSymmetries& given) {
  ModelOptions model_options = options.models;
  const auto num_threads = static_cast<std::size_t>(resolveNumThreads(options.common.threads));
  model_options.symmetries.num_threads = static_cast<int>(std::max<std::size_t>(1, num_threads / files.size()));
  std::vector<ModelInfo> infos(files.size());
  const Console console(options.common.quiet);
  Step searching(console, "Searching rotations of " + counted(files.size(), "model"));
  const auto errors = workOnAll(files.size(), options.common.threads, searching, [&](std::size_t i) {
    infos[i] = analyzeModel(files[i].path, model_options, givenFor(given, files[i].key));
    infos[i].key = files[i].key;
  });
  Results results;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (errors[i].empty())
      results.infos.push_back(std::move(infos[i]));
    else
      results.errors.push_back(errors[i]);
  }
  std::string outcome = std::to_string(results.infos.size()) + " done";
  if (!results.errors.empty()) outcome += ", " + std::to_string(results.errors.size()) + " failed";
  searching.done(outcome);
  for (const ModelInfo& info : results.infos)
    if (info.is_scan)
      console.warn(info.file +
                   ": is a scan from one side, must be a whole object; pcl_symmetry_planes finds the axes of "
                   "a scan");
  return results;
}

/// The entries by number, one per line, as in the benchmark's own files.
std::string modelsInfo(std::vector<ModelInfo> infos, double sphere_angle) {
  std::stable_sort(infos.begin(), infos.end(), [](const ModelInfo& a, const ModelInfo& b) {
    return a.key.size() != b.key.size() ? a.key.size() < b.key.size() : a.key < b.key;
  });
  std::string text;
  for (const ModelInfo& info : infos)
    text += (text.empty() ? "{\n  \"" : ",\n  \"") + info.key +
            "\": " + toJson(info, sphere_angle).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return text + "\n}\n";
}

void printColorNote(const std::vector<ModelInfo>& infos, bool use_colors) {
  const auto is_colored = [](const ModelInfo& info) { return info.has_unread_colors; };
  const auto num_colored = std::count_if(infos.begin(), infos.end(), is_colored);
  if (num_colored == 0) return;
  std::printf("%td of %zu models have colors, which were not looked at: %s\n", num_colored, infos.size(),
              use_colors ? "only those of vertices, and textures that PLY files name, can be read"
                         : "-color asks for rotations that keep them");
}

/// Writes the comparison with a given file as JSON, and prints it.
void report(const std::vector<ModelInfo>& infos, const BopOptions& options, bool prints) {
  nlohmann::ordered_json models = nlohmann::ordered_json::object(), missing = nlohmann::ordered_json::array();
  int num_disagreeing = 0, num_compared = 0;
  for (const ModelInfo& info : infos) {
    if (!info.check) {
      if (prints) std::printf("model %-6s is not in %s\n", info.key.c_str(), options.check_path->c_str());
      missing.push_back(info.key);
      continue;
    }
    if (prints) printCheck(info.key, *info.check, info.diameter);
    models[info.key] = toJson(*info.check, info.diameter);
    ++num_compared;
    num_disagreeing += info.check->agrees() ? 0 : 1;
  }
  if (prints)
    std::printf("%d of %d models disagree with %s\n", num_disagreeing, num_compared, options.check_path->c_str());
  if (options.report_path)
    writeText(*options.report_path, jsonText(nlohmann::ordered_json{
                                        {"disagreeing", num_disagreeing}, {"models", models}, {"missing", missing}}) +
                                        "\n");
}

void writeDope(const std::vector<ModelInfo>& infos, const std::string& folder, double sphere_angle) {
  for (const ModelInfo& info : infos) {
    const boost::filesystem::path model = boost::filesystem::path(folder) / boost::filesystem::path(info.file).stem();
    boost::system::error_code ignored;  // writeText() reports the missing folder
    boost::filesystem::create_directories(model, ignored);
    writeText((model / "model_info.json").string(), dopeJson(info.symmetries, sphere_angle).dump(2) + "\n");
  }
}

void writeIsaac(const std::vector<ModelInfo>& infos, const std::string& path) {
  std::string text;
  for (const ModelInfo& info : infos) {
    const IsaacAxes axes = isaacAxes(info.symmetries);
    text += isaacLine("\"" + info.key + "\"", axes.axes) + "  # " + info.symmetries.name() +
            (axes.is_complete ? "" : ", of which turns about x, y and z are only a part") + "\n";
  }
  writeText(path, text);
}

int run(int argc, char** argv) {
  BopOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  line.goWith("-check", options.check_path.has_value(), {"report"});
  line.goWith("-json or -dope", options.common.json_path || options.dope_folder, {"sphere_angle"});
  line.goWith("-absolute_tolerance 0", options.models.symmetries.absolute_tolerance == 0.0, {"tolerance"});
  line.goWith("-color", options.models.use_colors, {"color_tolerance"});
  const std::vector<ModelFile> files = modelFiles(options.inputs);
  const GivenSymmetries given = options.check_path ? readGiven(*options.check_path, files.size()) : GivenSymmetries{};
  ObjectSymmetryOptions& symmetries = options.models.symmetries;
  options.models.mesh_points = options.common.mesh_points;
  symmetries.num_cells = options.common.grid;
  symmetries.other_tolerances = options.models.explain;
  symmetries.max_points = std::max(symmetries.max_points, options.common.mesh_points);
  symmetries.seed = options.common.seed;
  const bool prints = isStandardOutputFree({options.common.json_path, options.report_path, options.isaac_path});
  const Results results = analyzeAll(files, options, given);
  if (prints) {
    for (const ModelInfo& info : results.infos) printModel(info);
    printColorNote(results.infos, options.models.use_colors);
  }
  const double sphere_angle = options.sphere_angle * kDegree;
  if (!results.infos.empty()) {
    if (options.check_path) report(results.infos, options, prints);
    if (options.common.json_path) writeText(*options.common.json_path, modelsInfo(results.infos, sphere_angle));
    if (options.dope_folder) writeDope(results.infos, *options.dope_folder, sphere_angle);
    if (options.isaac_path) writeIsaac(results.infos, *options.isaac_path);
  }
  const Console console(options.common.quiet);
  for (const std::string& error : results.errors) console.error(error);
  return results.errors.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
