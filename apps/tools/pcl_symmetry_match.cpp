/// Which models of a database are like a cloud, or are shown by it.
#include <algorithm>

#include "command_line/run_on_files.h"
#include "io/answers.h"
#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/symmetry_database.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct MatchOptions {
  BatchOptions batch;
  std::string database;
  int num_matches = 10;
  bool recognize = false;
  RecognitionOptions recognition;
  CommonOptions common;
};

CommandLine commandLine(MatchOptions& options) {
  CommandLine line("pcl_symmetry_match",
                   "Finds the models of a database that are most like clouds or meshes, in any pose and of any size. "
                   "With -recognize, the model that a scan shows, with its pose, or 'unknown object'.",
                   "pcl_symmetry_match models.db scan.pcd -recognize -json found.json");
  line.positional("database", options.database, "file of pcl_symmetry_database")
      .positionals("input", options.batch.inputs, kManyInputs)
      .number("max", options.num_matches, Range::closed(1, 1'000'000), "largest number of models shown")
      .flag("recognize", options.recognize, "bring the models to the scan and keep those that fit")
      .number("candidates", options.recognition.num_candidates, Range::closed(1, 1'000'000),
              "number of models most like the scan that are tried")
      .number("min_confidence", options.recognition.min_confidence, Range::closed(0, 1),
              "least confidence of a known model")
      .common(options.common, kMeshPoints | kJson | kThreads | kViewpoint | kQuiet);
  options.batch.addTo(line);
  return line;
}

FileReport match(const FileJob& job, const SymmetryDatabase& database, const InputShape& input,
                 const MatchOptions& options) {
  Step step(job.console, "Matching");
  const std::vector<ModelMatch> matches =
      database.match(*input.points, options.num_matches, input.viewpoint(options.common));
  step.done(std::to_string(matches.size()) + " of " + counted(database.size(), "model"));
  FileReport report{"", {{"file", job.path}, {"matches", nlohmann::json::array()}}, {}};
  for (const ModelMatch& found : matches) {
    report.text += formatted("%s  distance %.4f\n", found.name.c_str(), found.distance);
    report.json["matches"].push_back({{"name", found.name}, {"distance", found.distance}});
    report.rows.push_back({found.name, found.distance});
  }
  return report;
}

FileReport recognize(const FileJob& job, const SymmetryDatabase& database, const InputShape& input,
                     const MatchOptions& options) {
  RecognitionOptions recognition = options.recognition;
  recognition.num_threads = job.common.threads;
  Step step(job.console, "Recognizing");
  Recognition found = database.recognize(*input.points, recognition, input.viewpoint(options.common));
  found.resize(std::min(found.size(), static_cast<std::size_t>(options.num_matches)));
  FileReport report{"", {{"file", job.path}, {"known", !found.empty()}, {"models", nlohmann::json::array()}}, {}};
  if (found.empty()) {
    const std::string reason =
        formatted("none of %zu reaches a confidence of %g", database.size(), recognition.min_confidence);
    step.done("unknown object, " + reason);
    report.text = "unknown object\n";
    report.json["reason"] = reason;
    return report;
  }
  step.done(found.front().name);
  for (const RecognizedModel& model : found) {
    const Eigen::Isometry3d T_model_scan = shiftedBack(model.T_model_scan, input.shift(), Eigen::Vector3d::Zero());
    report.text += formatted("%s  confidence %.3f  support %.3f  conflict %.3f\n", model.name.c_str(), model.confidence,
                             model.score.support, model.score.conflict) +
                   matrixLines(T_model_scan, lengthDigits(input.shift()));
    report.json["models"].push_back({{"name", model.name},
                                     {"confidence", model.confidence},
                                     {"support", model.score.support},
                                     {"conflict", model.score.conflict},
                                     {"transform", rowMajor(T_model_scan)}});
    report.rows.push_back({model.name, model.confidence, model.score.support, model.score.conflict});
  }
  return report;
}

int run(int argc, char** argv) {
  MatchOptions options;
  options.common.mesh_points = kDatabaseMeshPoints;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  line.goWith("-recognize", options.recognize, {"candidates", "min_confidence"});
  checkReadableFile(options.database);
  DatabaseOptions database_options;
  database_options.num_threads = options.common.threads;
  const SymmetryDatabase database(options.database, database_options);
  if (database.size() == 0) throw InputError(options.database + ": holds no models");
  const std::vector<std::string> columns = options.recognize
                                               ? std::vector<std::string>{"model", "confidence", "support", "conflict"}
                                               : std::vector<std::string>{"model", "distance"};
  return runOnFiles(options.batch, options.common, columns, [&](FileJob& job) {
    const InputShape input = loadInput(job.path, options.common.mesh_points, options.common.seed);
    if (const std::string reason = detail::reasonForNoAnswer(finitePoints(*input.points)); !reason.empty())
      throw InputError(job.path + ": " + reason);
    job.report(namingFile(job.path, [&] {
      return options.recognize ? recognize(job, database, input, options) : match(job, database, input, options);
    }));
  });
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
