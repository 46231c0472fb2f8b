/// Fits the weights that merge patches into parts, and writes the source that holds them.
#include <array>
#include <cstdio>

#include "calibrate/merge_fitting.h"
#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/command_line/run_tool.h"
#include "common/shape_input/shape_input.h"
#include "common/shape_output/face_labels.h"
#include "common/shape_output/shape_output.h"
#include "core/base/parallel.h"
#include "evaluate/people/segment_files.h"
#include "evaluate/segmentation/segmentation_report.h"
#include "evaluate/shared/model_flags.h"
#include "pcl_symmetry/symmetry_segmentation.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct Kind {
  MergingEvidence evidence;
  const char* name;
};
// derived: all kinds of evidence, in the order of the enumeration.
constexpr std::array<Kind, 5> kKinds{{{MergingEvidence::Symmetry, "symmetry"},
                                      {MergingEvidence::SymmetryAndConcavity, "concavity"},
                                      {MergingEvidence::All, "all"},
                                      {MergingEvidence::AllButSymmetry, "no-symmetry"},
                                      {MergingEvidence::Nothing, "nothing"}}};
// derived: all cues, in their order.
constexpr std::array<const char*, kNumCues> kCueNames{
    "always",       "contact",        "small area",      "large area",      "support differs",
    "images",       "edge concavity", "patch concavity", "inner concavity", "thickness ratio",
    "constriction", "sight",          "relative sight",  "sight of small"};
// chosen: from a pull that changes no digit that is written to one that takes the weights away.
const std::vector<double> kRidges{1e-3, 0.1, 1.0, 10.0, 100.0};

struct CalibrationOptions {
  std::string meshes, references;
  ModelSelection selection;
  bool path = false;
  std::optional<std::string> output;
  CommonOptions common;
};

CommandLine commandLine(CalibrationOptions& options) {
  CommandLine line("calibrate_segments", "Fits the weights that merge patches of a surface into parts.",
                   "calibrate_segments psb/off psb/seg/Benchmark -list apps/calibrate/segments_fit.txt -path -output "
                   "src/core/segmentation/cues/merge_fit.h");
  line.positional("meshes", options.meshes, "folder of .off, .ply, .obj and .stl meshes, 12.off ...")
      .positional("references", options.references, "folder of .seg files: 12/12_0.seg, or 12_0.seg, ...");
  addSelectionFlags(line, options.selection);
  line.flag("path", options.path, "also print fits with stronger pulls to 0, measured on categories left out of them")
      .text("output", "FILE.h", options.output, "C++ header with the weights")
      .common(options.common, kThreads | kQuiet);
  return line;
}

/// A mesh with the segments of people, divided into patches that know of concave edges, and into others that do not.
/// Kinds of evidence with less than all of it leave cues out.
struct PeopledMesh {
  std::string name;
  PeopledDivision with_concavity, without_concavity;
};

PeopledMesh peopledMesh(const Model& model, const std::string& references) {
  const Shape shape = loadShape(model.path);
  if (!shape.mesh) throw InputError(model.path + ": has no faces");
  std::vector<std::vector<int>> people;
  for (const std::string& path : segmentFilesOf(references, model.name)) {
    people.push_back(readFaceLabels(path));
    if (people.back().size() != shape.mesh->polygons.size())
      throw InputError(path + ": has another number of labels than " + model.path + " has faces");
  }
  if (people.empty()) throw InputError(model.path + ": no .seg file in " + references);
  SegmentationOptions options;
  options.num_threads = 1;
  const SurfaceGraph graph = meshGraph(*shape.mesh);
  const WholeEvidence whole(graph, options);
  return {model.name, peopledDivision(whole.ofDivision(0, MergingEvidence::All), people),
          peopledDivision(whole.ofDivision(0, MergingEvidence::Symmetry), people)};
}

std::vector<PeopledMesh> peopledMeshes(const CalibrationOptions& options) {
  const Console console(options.common.quiet);
  const std::vector<Model> models = listModels({options.meshes}, options.selection);
  std::vector<PeopledMesh> meshes(models.size());
  Step step(console, "Dividing " + std::to_string(models.size()) + " meshes");
  parallelBlocks(models.size(), options.common.threads,
                 [&](std::size_t i) { meshes[i] = peopledMesh(models[i], options.references); });
  step.done();
  return meshes;
}

void print(const Kind& kind, const MergeFitting& fitting, std::size_t num_models) {
  std::printf("\n%s: %zu models, %zu merges, Rand distance of patches %.4f\n", kind.name, num_models,
              fitting.num_samples, fitting.fit.rand);
  for (const Cue cue : cuesOf(kind.evidence))
    std::printf("  %-16s %8.3f  (%.3f to %.3f)\n", kCueNames[cue], fitting.fit.weights[cue],
                fitting.fit.weights[cue] - fitting.half_width[cue], fitting.fit.weights[cue] + fitting.half_width[cue]);
}

void print(const Kind& kind, const std::vector<PathPoint>& path) {
  std::printf("%-10s %9s  weights\n", "pull to 0", "left out");
  for (const PathPoint& point : path) {
    std::printf("%-10g %9.4f ", point.ridge, point.rand);
    for (const Cue cue : cuesOf(kind.evidence)) std::printf(" %.2f", point.weights[cue]);
    std::printf("\n");
  }
}

std::string headerText(const std::array<MergeFitting, kKinds.size()>& fits, const std::vector<PeopledMesh>& meshes) {
  std::string rows, names;
  char text[64];
  for (std::size_t k = 0; k < fits.size(); ++k) {
    rows += std::string(k > 0 ? ",\n" : "") + "    // " + kKinds[k].name + "\n    {";
    for (std::size_t c = 0; c < fits[k].fit.weights.size(); ++c) {
      std::snprintf(text, sizeof(text), "%s%.4g",
                    c == 0              ? ""
                    : c == kNumCues / 2 ? ",\n     "
                                        : ", ",
                    fits[k].fit.weights[c]);
      rows += text;
    }
    rows += "}";
  }
  std::size_t width = 0;
  for (const PeopledMesh& mesh : meshes) {
    const bool breaks = width + mesh.name.size() > 100;
    names += breaks ? "\n// " + mesh.name : " " + mesh.name;
    width = breaks ? mesh.name.size() : width + 1 + mesh.name.size();
  }
  return "// Written by calibrate_segments; see test/benchmark/README.md. Do not edit.\n#pragma once\n\n#include "
         "\"core/segmentation/cues/merge_cues.h\"\n\nnamespace pcl_symmetry {\n\n// fitted: log odds per unit of each "
         "cue, by MergingEvidence, on the " +
         std::to_string(meshes.size()) + " meshes\n//" + names +
         ".\ninline constexpr std::array<MergeWeights, 5> kMergeFit{{\n" + rows +
         "}};\n\n}  // namespace pcl_symmetry\n";
}

int run(int argc, char** argv) {
  CalibrationOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  const std::vector<PeopledMesh> meshes = peopledMeshes(options);
  std::array<MergeFitting, kKinds.size()> fits;
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    std::vector<PeopledModel> models;
    for (const PeopledMesh& mesh : meshes)
      models.push_back({benchmarkCategory(mesh.name),
                        usesConcavity(kKinds[k].evidence) ? &mesh.with_concavity : &mesh.without_concavity});
    MergeFitter fitter(models, cuesOf(kKinds[k].evidence), options.common.threads);
    fits[k] = fitter.fit();
    print(kKinds[k], fits[k], models.size());
    if (options.path) print(kKinds[k], fitter.path(kRidges));
    std::fflush(stdout);
  }
  const std::string header = headerText(fits, meshes);
  std::printf("\n%s", header.c_str());
  if (options.output) writeText(*options.output, header);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
