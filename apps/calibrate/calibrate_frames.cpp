/// Fits the probabilities of frames, and writes the source that holds their weights.
#include <array>
#include <cstdio>

#include "calibrate/frames/frame_fitting.h"
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
  std::optional<int> judged_fold;
  int num_views = 2;
  std::optional<std::string> output;
  CommonOptions common;
};

CommandLine commandLine(CalibrationOptions& options) {
  CommandLine line("calibrate_frames", "Fits the probabilities that a frame is the one in which people put a shape.",
                   "calibrate_frames psb/train -classes train.cla -fold 0 -judged_fold 1 -output "
                   "src/core/frame/probable/frame_fit.h");
  addModelFlags(line, options.folders, options.selection);
  line.number("judged_fold", options.judged_fold, Range::closed(0, 99), "print how well the fit foretells this fold")
      .number("num_views", options.num_views, Range::closed(1, 8), "number of scans of each model")
      .text("output", "FILE.h", options.output, "C++ header with the weights")
      .common(options.common, kThreads | kQuiet);
  return line;
}

struct SampledModels {
  std::size_t num_models = 0;
  std::vector<FrameSample> samples;
};

SampledModels sampleAll(const CalibrationOptions& options, const ModelSelection& selection) {
  const Console console(options.common.quiet);
  const std::vector<Model> models = listModels(options.folders, selection);
  Step step(console, "Sampling " + std::to_string(models.size()) + " models");
  std::vector<std::vector<FrameSample>> all(models.size());
  std::vector<std::string> left_out(models.size());
  parallelBlocks(models.size(), options.common.threads, [&](std::size_t i) {
    try {
      all[i] = sampleFrames(models[i], options.num_views);
    } catch (const std::exception& error) {
      left_out[i] = models[i].path + ": " + error.what();
    }
  });
  SampledModels sampled;
  for (const std::vector<FrameSample>& some : all) {
    sampled.num_models += some.empty() ? 0 : 1;
    sampled.samples.insert(sampled.samples.end(), some.begin(), some.end());
  }
  step.done(std::to_string(sampled.samples.size()) + " clouds");
  for (const std::string& reason : left_out)
    if (!reason.empty()) console.warn("left out: " + reason);
  return sampled;
}

/// How often frames are right, and whether the stated probabilities come true: of all frames, of the frame itself and
/// of the most probable one.
void report(const std::vector<FrameSample>& samples, const FrameWeights& weights) {
  std::vector<Reliability> groups;
  for (const bool scanned : {false, true}) {
    const std::string kind = scanned ? "scan" : "whole";
    std::array<std::vector<Forecast>, 3> forecasts;
    Proportion itself, most_probable, any;
    for (const FrameSample& sample : samples) {
      if (sample.scanned != scanned || sample.choices.empty()) continue;
      const std::vector<double> p = frameProbabilities(sample.choices, weights.of(sample));
      std::size_t best = 0;
      bool one_right = false;
      for (std::size_t i = 0; i < p.size(); ++i) {
        forecasts[0].push_back({p[i], sample.right[i]});
        one_right |= sample.right[i];
        if (p[i] > p[best]) best = i;
      }
      forecasts[1].push_back({p[0], sample.right[0]});
      forecasts[2].push_back({p[best], sample.right[best]});
      itself.add(sample.right[0]);
      most_probable.add(sample.right[best]);
      any.add(one_right);
    }
    std::printf("%-6s own axes: the frame %s, the most probable one %s, any of them %s\n", kind.c_str(),
                itself.text().c_str(), most_probable.text().c_str(), any.text().c_str());
    groups.push_back(reliabilityOf(kind + ", all frames", forecasts[0], {}));
    groups.push_back(reliabilityOf(kind + ", the frame", forecasts[1], {}));
    groups.push_back(reliabilityOf(kind + ", the most probable", forecasts[2], {}));
  }
  printReliability(groups);
}

int run(int argc, char** argv) {
  CalibrationOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  const SampledModels sampled = sampleAll(options, options.selection);
  const FrameWeights weights = fitFrameWeights(sampled.samples);
  const std::string header = headerText(weights, sampled.num_models, sampled.samples.size());
  std::printf("Of the models of the fit:\n");
  report(sampled.samples, weights);
  if (options.judged_fold) {
    ModelSelection judged = options.selection;
    judged.fold = options.judged_fold;
    std::printf("Of the models of fold %d:\n", *options.judged_fold);
    report(sampleAll(options, judged).samples, weights);
  }
  std::printf("%s", header.c_str());
  if (options.output) writeText(*options.output, header);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
