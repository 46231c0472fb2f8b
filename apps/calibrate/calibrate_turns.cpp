/// Fits the numbers of the confidence of turns of scans, and writes the source that holds them.
#include <algorithm>
#include <cstdio>

#include "calibrate/turns/turn_fitting.h"
#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/command_line/run_tool.h"
#include "common/shape_output/shape_output.h"
#include "core/base/parallel.h"
#include "core/detection/scan_axes/turn_confidence.h"
#include "evaluate/calibration/reliability.h"
#include "evaluate/shared/model_flags.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct CalibrationOptions {
  std::vector<std::string> folders;
  ModelSelection selection;
  int num_scans = 2, num_solids = 480;
  std::optional<std::string> csv, from, output;
  CommonOptions common;
};

CommandLine commandLine(CalibrationOptions& options) {
  CommandLine line("calibrate_turns", "Fits the numbers of the confidence of turns of scans.",
                   "calibrate_turns psb/train -classes train.cla -fold 0 -output "
                   "src/core/detection/scan_axes/turn_confidence_fit.h");
  addModelFlags(line, options.folders, options.selection);
  line.number("scans", options.num_scans, Range::closed(1, 1000), "number of scans of each model")
      .number("solids", options.num_solids, Range::closed(0, 100'000),
              "number of scans of solids of `pcl_symmetry_evaluate shapes turns -half tuning`")
      .text("csv", "FILE", options.csv, "a row for each turn: what the scan shows, and what is true")
      .text("from", "FILE", options.from, "fit to the turns of this file, which -csv wrote, and scan nothing")
      .text("output", "FILE.h", options.output, "C++ header with the numbers")
      .common(options.common, kThreads | kQuiet);
  return line;
}

/// The turns of scans of all models and solids, as a table.
std::string sampledTurns(const CalibrationOptions& options) {
  const Console console(options.common.quiet);
  const std::vector<Model> models = listModels(options.folders, options.selection);
  std::vector<std::string> names;
  for (const Model& model : models) names.push_back(model.name);
  for (int i = 0; i < options.num_solids; ++i) names.push_back(solidName(i));
  std::vector<std::vector<JudgedTurn>> turns(names.size());
  std::vector<std::string> left_out(names.size());
  Step step(console, "Scanning " + std::to_string(models.size()) + " models and " + std::to_string(options.num_solids) +
                         " solids");
  parallelBlocks(names.size(), options.common.threads, [&](std::size_t i) {
    try {
      turns[i] = i < models.size() ? judgedTurns(models[i], options.num_scans)
                                   : judgedTurnsOfSolid(static_cast<int>(i - models.size()), false);
    } catch (const std::exception& error) {
      left_out[i] = names[i] + ": " + error.what();
    }
  });
  step.done();
  for (const std::string& reason : left_out)
    if (!reason.empty()) console.warn("left out: " + reason);
  return turnTable(names, turns);
}

/// Whether the stated probabilities come true, of what takes part in the fit.
void printReliabilities(const std::vector<JudgedTurn>& turns, const std::array<TurnFit, 3>& fit) {
  std::array<std::vector<Forecast>, 3> forecasts;
  for (const JudgedTurn& one : turns)
    forecasts[static_cast<std::size_t>(kindOf(one.turn))].push_back({confidenceOf(one, fit), one.isRight()});
  std::vector<Reliability> groups;
  for (std::size_t kind = 0; kind < forecasts.size(); ++kind)
    groups.push_back(reliabilityOf(kTurnKinds[kind], forecasts[kind], {}));
  printReliability(groups);
}

int run(int argc, char** argv) {
  CalibrationOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (!options.from && !options.csv) throw UsageError("-csv FILE is needed where the scans are not -from a file");
  if (!options.from) writeText(*options.csv, sampledTurns(options));
  const std::vector<JudgedTurn> turns = readTurnTable(options.from ? *options.from : *options.csv);
  const std::array<TurnFit, 3> fit = fitTurns(turns);
  printReliabilities(turns, fit);
  const std::string header = headerText(fit);
  std::printf("%s", header.c_str());
  if (options.output) writeText(*options.output, header);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
