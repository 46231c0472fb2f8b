/// Which models of a database a cloud is like, or shows.
#include <pcl/exceptions.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "console.h"
#include "input_cloud.h"
#include "options.h"
#include "pcl_symmetry/recognition/symmetry_database.h"
#include "shape_output.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct MatchOptions {
  std::string folder, input;
  int num_matches = 10;
  bool recognize = false;
  RecognitionOptions recognition;
  int mesh_points = 20'000;
  CommonOptions common;
};

CommandLine commandLine(MatchOptions& options) {
  CommandLine line("pcl_symmetry_match",
                   "Finds the models of a database that are most like a cloud or mesh, in any pose and of any size. "
                   "With -recognize, the model that a scan shows, with its pose, or 'unknown object'.",
                   "pcl_symmetry_match models.db scan.pcd -recognize -json found.json");
  line.positional("database", options.folder, "folder of pcl_symmetry_database")
      .positional("input", options.input, ".pcd, .ply, .obj, .stl or .off")
      .number("max", options.num_matches, Range::closed(1, 1'000'000), "models to show")
      .flag("recognize", options.recognize, "bring the models to the scan and keep those that fit")
      .number("candidates", options.recognition.num_candidates, Range::closed(1, 1'000'000),
              "models that are brought to the scan")
      .number("min_merit", options.recognition.min_merit, Range::closed(-1, 1), "of a pose by which a model is known")
      .number("points", options.mesh_points, Range::closed(100, 10'000'000), "spread over a mesh")
      .common(options.common, kJson | kThreads | kViewpoint | kQuiet);
  return line;
}

nlohmann::json toJson(const Eigen::Isometry3d& transform) {
  nlohmann::json numbers = nlohmann::json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) numbers.push_back(transform.matrix()(row, column));
  return numbers;
}

nlohmann::json match(const Console& console, const SymmetryDatabase& database, const SymmetryDatabase::Cloud& cloud,
                     const MatchOptions& options) {
  Step step(console, "Matching");
  const std::vector<ModelMatch> matches = database.match(cloud, options.num_matches, options.common.viewpoint);
  step.done(std::to_string(matches.size()) + " of " + std::to_string(database.size()) + " models");
  nlohmann::json json{{"matches", nlohmann::json::array()}};
  for (const ModelMatch& found : matches) {
    std::printf("%8.4f %s\n", found.distance, found.name.c_str());
    json["matches"].push_back({{"name", found.name}, {"distance", found.distance}});
  }
  return json;
}

nlohmann::json recognize(const Console& console, const SymmetryDatabase& database, const SymmetryDatabase::Cloud& cloud,
                         const MatchOptions& options) {
  RecognitionOptions recognition = options.recognition;
  recognition.num_threads = options.common.threads;
  Step step(console, "Recognizing");
  Recognition found = database.recognize(cloud, recognition, options.common.viewpoint);
  found.resize(std::min(found.size(), static_cast<std::size_t>(options.num_matches)));
  step.done(found.empty() ? "unknown object" : found.front().name);
  nlohmann::json json{{"known", !found.empty()}, {"models", nlohmann::json::array()}};
  if (found.empty()) std::printf("unknown object\n");
  for (const RecognizedModel& model : found) {
    std::printf("%s  confidence %.3f  support %.3f  conflict %.3f\n", model.name.c_str(), model.confidence,
                model.score.support, model.score.conflict);
    json["models"].push_back({{"name", model.name},
                              {"confidence", model.confidence},
                              {"support", model.score.support},
                              {"conflict", model.score.conflict},
                              {"transform", toJson(model.T_model_scan)}});
  }
  return json;
}

int run(int argc, char** argv) {
  MatchOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  const Console console(options.common.quiet);
  const auto cloud = loadInputCloud(options.input, options.mesh_points);
  try {
    DatabaseOptions database_options;
    database_options.num_threads = options.common.threads;
    const SymmetryDatabase database(options.folder, database_options);
    if (database.size() == 0) throw InputError(options.folder + ": holds no models");
    const nlohmann::json json =
        options.recognize ? recognize(console, database, *cloud, options) : match(console, database, *cloud, options);
    if (options.common.json_path) writeText(*options.common.json_path, json.dump(2) + "\n");
  } catch (const pcl::BadArgumentException& error) {
    throw InputError(options.input + ": " + error.detailedMessage());
  } catch (const pcl::IOException& error) {
    throw InputError(error.detailedMessage());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
