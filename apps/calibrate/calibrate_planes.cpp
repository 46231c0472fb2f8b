/// Fits the numbers of the decision whether a plane is a symmetry, and writes the source that holds them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "calibrate/planes/confidence_fitting.h"
#include "calibrate/planes/decision_report.h"
#include "calibrate/planes/evidence_samples.h"
#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/command_line/run_tool.h"
#include "common/shape_output/shape_output.h"
#include "core/base/parallel.h"
#include "evaluate/calibration/reliability.h"
#include "evaluate/shared/model_flags.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct CalibrationOptions {
  std::vector<std::string> folders;
  ModelSelection selection;
  double tolerance = 0.01;
  int num_shapes = 144, num_parts = 0;
  std::optional<std::string> csv, from, others, output;
  bool sensitivity = false;
  CommonOptions common;
};

CommandLine commandLine(CalibrationOptions& options) {
  CommandLine line("calibrate_planes", "Fits the numbers of the decision whether a plane is a symmetry.",
                   "calibrate_planes psb/train -classes train.cla -fold 0 -output src/core/evidence/confidence_fit.h");
  addModelFlags(line, options.folders, options.selection);
  line.number("tolerance", options.tolerance, Range::upTo(0, 0.1), "of a symmetry, as a share of the diameter")
      .number("shapes", options.num_shapes, Range::closed(0, 100'000),
              "number of clouds of shapes with folds, made by code")
      .text("csv", "FILE", options.csv, "a row for each plane: what the detector saw, and its true share")
      .text("from", "FILE", options.from, "fit to the planes of this file, which -csv wrote, and sample no clouds")
      .text("others", "FILE", options.others, "print what the fit decides on the planes of this file too")
      .flag("sensitivity", options.sensitivity, "print what half and twice of each chosen unit decides on -others")
      .number("cross_validation", options.num_parts, Range::closed(0, 100),
              "also judge each plane by a fit to the other models, of which one part in this many is left out; 0 = not")
      .text("output", "FILE.h", options.output, "C++ header with the numbers")
      .common(options.common, kThreads | kQuiet);
  return line;
}

/// Whether the stated probabilities come true, of what takes part in the fit.
void printReliabilities(const std::vector<EvidenceSample>& samples, const DecisionFit& fit) {
  std::array<std::vector<Forecast>, 3> forecasts;
  for (const EvidenceSample& sample : samples)
    forecasts[static_cast<std::size_t>(kindOf(sample.evidence))].push_back(
        {1.0 / (1.0 + std::exp(-logOdds(sample.evidence, fit))), isSymmetry(sample)});
  std::vector<Reliability> groups;
  for (std::size_t kind = 0; kind < forecasts.size(); ++kind)
    groups.push_back(reliabilityOf(kKindNames[kind], forecasts[kind], {}));
  printReliability(groups);
}

/// The candidates of all models and shapes.
std::vector<EvidenceSample> sampleAll(const CalibrationOptions& options) {
  const Console console(options.common.quiet);
  const std::vector<Model> models = listModels(options.folders, options.selection);
  const std::size_t num_all = models.size() + static_cast<std::size_t>(options.num_shapes);
  Step step(console,
            "Sampling " + std::to_string(models.size()) + " models, " + std::to_string(options.num_shapes) + " shapes");
  std::vector<std::vector<EvidenceSample>> all(num_all);
  std::vector<std::string> left_out(models.size());
  parallelBlocks(num_all, options.common.threads, [&](std::size_t i) {
    if (i >= models.size()) {
      all[i] = sampleFoldedEvidence(static_cast<int>(i - models.size()), options.tolerance);
      return;
    }
    try {
      all[i] = sampleEvidence(models[i], options.tolerance);
    } catch (const std::exception& error) {
      left_out[i] = models[i].path + ": " + error.what();
    }
  });
  std::vector<EvidenceSample> samples;
  for (const std::vector<EvidenceSample>& some : all) samples.insert(samples.end(), some.begin(), some.end());
  step.done(std::to_string(samples.size()) + " planes");
  for (const std::string& reason : left_out)
    if (!reason.empty()) console.warn("left out: " + reason);
  return samples;
}

/// What the fit decides on planes of other models.
void report(const std::vector<EvidenceSample>& samples, const DecisionFit& fit, const CalibrationOptions& options) {
  const std::vector<EvidenceSample> others = readEvidenceTable(*options.others);
  std::printf("Of %s:\n", options.others->c_str());
  printDecisions(decisionsOf(others, fit));
  if (options.sensitivity) printSensitivity(samples, others);
}

int run(int argc, char** argv) {
  CalibrationOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (options.num_parts == 1) throw UsageError("-cross_validation = 1, must be 0, or 2 and more");
  if (options.sensitivity && !options.others) throw UsageError("-sensitivity needs -others");
  std::vector<EvidenceSample> samples = options.from ? readEvidenceTable(*options.from) : sampleAll(options);
  if (options.csv) writeText(*options.csv, evidenceTable(samples));
  std::set<std::string> models;
  for (const EvidenceSample& sample : samples) models.insert(sample.model);
  const DecisionFit fit = fitDecision(samples);
  for (std::size_t kind = 0; kind < fit.size(); ++kind)
    std::printf("%-8s %5d symmetric, %5d asymmetric planes\n", kKindNames[kind], fit[kind].num_symmetric,
                fit[kind].num_asymmetric);
  printDecisions(decisionsOf(samples, fit));
  printReliabilities(samples, fit);
  if (options.num_parts > 0) {
    const std::array<double, 3> losses = crossValidation(samples, options.num_parts);
    for (std::size_t kind = 0; kind < losses.size(); ++kind)
      std::printf("%-8s %.4f nats a plane by fits to other models\n", kKindNames[kind], losses[kind]);
  }
  if (options.others) report(samples, fit, options);
  const std::string header = headerText(fit, models.size(), options.tolerance);
  std::printf("%s", header.c_str());
  if (options.output) writeText(*options.output, header);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
