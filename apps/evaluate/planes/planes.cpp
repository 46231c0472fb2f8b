#include "evaluate/planes/planes.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/shape_output/shape_output.h"
#include "evaluate/planes/models/model_evaluation.h"
#include "evaluate/planes/plane_report.h"
#include "evaluate/references/reference_cache.h"
#include "evaluate/runs/resumable_run.h"
#include "evaluate/shared/model_flags.h"
#include "evaluate/shared/model_list.h"

namespace pcl_symmetry::apps {

namespace {

// Milliseconds between two savings of the references. chosen: an interrupted run loses no more; half writes more often,
// twice loses more.
constexpr double kSaveEvery = 10'000.0;

void addReferenceFlags(CommandLine& line, EvaluatePlanesOptions& o) {
  line.text("references", "FILE", o.references_path,
            "reference planes: read for the meshes in it, extended by the others")
      .number("tolerance", o.references.tolerance, Range::open(0, 1),
              "largest distance of a reflected point from the mesh, see -tolerance_of")
      .choice("tolerance_of", o.tolerance_of, {"diameter", "diagonal"},
              "unit of -tolerance: the greatest distance between two points, or the diagonal of the bounding box")
      .choice(
          "references_by", o.references_by, {"brute_force", "transform"},
          "search of the references: all planes on the mesh, or maxima of this library's transform, as the detector")
      .number("min_share", o.references.min_share, Range::closed(0.5, 1),
              "least share of the area that a reference plane maps to the mesh")
      .number("near_share", o.references.near_share, Range::closed(0.5, 1),
              "least share of a near plane, which is neither right nor wrong");
}

void addCloudFlags(CommandLine& line, EvaluatePlanesOptions& o) {
  line.choice("sweep", o.sweep, {"none", "noise", "points", "missing", "views"},
              "vary one thing; none: the clouds of -rows")
      .text("rows", "A,B,...", o.rows,
            "kinds of clouds: whole without noise; noise: whole at -noise; scan: with viewpoint; moved: the same scans "
            "moved and without viewpoint; crop: whole, a random plane cuts off -crops; sampling: whole, random, voxel, "
            "scanners and rings (whole,noise,scan,moved,crop)")
      .number("points", o.clouds.num_points, Range::closed(100, 10'000'000), "number of points per cloud")
      .numbers("noise", o.clouds.noise, Range::closed(0, 1),
               "standard deviations of the noise of whole clouds, in diagonals")
      .numbers("scan_noise", o.clouds.scan_noise, Range::closed(0, 1),
               "standard deviations of the depth of scans, in diagonals")
      .numbers("missing", o.clouds.missing, Range{0, 1, false, true},
               "shares of the points that are cut off, for -sweep missing")
      .numbers("crops", o.clouds.crops, Range{0, 1, false, true},
               "shares of the points that are cut off, of -rows crop")
      .numbers("point_counts", o.clouds.point_counts, Range::closed(10, 10'000'000),
               "numbers of points, for -sweep points")
      .choice("views", o.views, {"corners", "random", "none"}, "scans from corners of a cube or random directions")
      .number("num_views", o.clouds.num_views, Range::closed(1, 1000),
              "number of scans of each mesh, at most 8 from corners");
}

CommandLine commandLine(EvaluatePlanesOptions& o) {
  CommandLine line(
      "pcl_symmetry_evaluate planes",
      "Makes whole clouds and single-view scans of meshes and measures how well their planes are found.",
      "pcl_symmetry_evaluate planes psb/train -every 4 -max 200 -references references.json -csv clouds.csv");
  addModelFlags(line, o.folders, o.selection);
  addReferenceFlags(line, o);
  addCloudFlags(line, o);
  line.number("max_angle", o.limits.max_angle, Range::open(0, 90),
              "largest angle between a found plane and its reference, degrees")
      .number("max_axis_angle", o.limits.max_axis_angle, Range::open(0, 90),
              "largest angle between a found axis and its reference, degrees")
      .number("max_offset", o.limits.max_offset, Range::open(0, 1),
              "largest offset between a finding and its reference, in diagonals")
      .number("detect_tolerance", o.detect_tolerance, Range::upTo(0, 0.1),
              "of a symmetry, asked of the detector, as a share of the diameter; -tolerance is that of the references")
      .number("min_confidence", o.operating_point.min_confidence, Range::closed(0, 1),
              "least confidence of an answer that decides: one operating point for right and wrong decisions")
      .text("export", "DIR", o.export_folder, "write every cloud as PCD, and ground_truth.json")
      .flag("no_detect", o.no_detect, "only find references and export")
      .text("planes", "DIR", o.planes_folder,
            "judge NAME.json ({\"planes\": [{\"coefficients\": [a,b,c,d], \"score\": s}]}) or NAME.txt (lines a b c d "
            "[score]) of each cloud instead of detecting; NAME as -export has it")
      .text("csv", "FILE", o.cloud_csv, "a row for each cloud")
      .text("model_csv", "FILE", o.model_csv, "a row for each model")
      .text("reliability_csv", "FILE", o.reliability_csv, "right answers by confidence")
      .text("share_csv", "FILE", o.share_csv, "clouds called symmetric by the true share of the model's best plane")
      .text("curve_csv", "FILE", o.curve_csv, "precision and recall at every score")
      .picture("png", o.png, "chart: precision against recall, or the rates of a sweep");
  ResumableRun::addFlag(line, o.journal);
  line.common(o.common, kJson | kSeed | kThreads | kQuiet);
  return line;
}

Sweep sweepNamed(const std::string& name) {
  static const std::map<std::string, Sweep> sweeps = {{"none", Sweep::None},
                                                      {"noise", Sweep::Noise},
                                                      {"points", Sweep::Points},
                                                      {"missing", Sweep::Missing},
                                                      {"views", Sweep::Views}};
  return sweeps.at(name);
}

std::vector<CloudRow> rowsNamed(const std::string& names) {
  static const std::map<std::string, CloudRow> rows = {{"whole", CloudRow::Whole}, {"noise", CloudRow::Noise},
                                                       {"scan", CloudRow::Scan},   {"moved", CloudRow::Moved},
                                                       {"crop", CloudRow::Crop},   {"sampling", CloudRow::Sampling}};
  std::vector<std::string> parts;
  boost::algorithm::split(parts, names, boost::algorithm::is_any_of(","));
  std::vector<CloudRow> found;
  for (const std::string& part : parts) {
    const auto row = rows.find(part);
    if (row == rows.end())
      throw UsageError("-rows: '" + part + "', must be of whole, noise, scan, moved, crop, sampling");
    found.push_back(row->second);
  }
  return found;
}

void completeOptions(EvaluatePlanesOptions& o, const CommandLine& line) {
  if (o.references.near_share > o.references.min_share) throw UsageError("-near_share must be <= -min_share");
  if (o.no_detect && o.planes_folder) throw UsageError("only one of -no_detect and -planes may be given");
  if (o.planes_folder && !boost::filesystem::is_directory(*o.planes_folder))
    throw InputError(*o.planes_folder + ": must be a folder");
  o.clouds.sweep = sweepNamed(o.sweep);
  o.clouds.rows = rowsNamed(o.rows.value_or("whole,noise,scan,moved,crop"));
  o.references.by_transform = o.references_by == "transform";
  o.references.tolerance_in_diagonals = o.tolerance_of == "diagonal";
  if (o.clouds.sweep == Sweep::Views && !line.given("views")) o.views = "random";
  if (o.clouds.sweep == Sweep::Views && o.views == "none") throw UsageError("-sweep views needs -views");
  o.clouds.random_views = o.views == "random";
  if (o.views == "none") o.clouds.num_views = 0;
  o.clouds.seed = o.common.seed;
  o.references.num_threads = o.common.threads;
}

class PlanesEvaluation {
public:
  PlanesEvaluation(const EvaluatePlanesOptions& options, ResumableRun& work)
      : options_(options),
        work_(work),
        console_(options.common.quiet || !work.isFirst()),
        recipes_(recipesFor(options.clouds)),
        cache_(options.references_path.value_or(""), options.references) {}

  void run() {
    const std::vector<Model> models = listModels(options_.folders, options_.selection);
    if (options_.export_folder) makeFolder(*options_.export_folder);
    evaluate(models);
    if (!work_.isFirst()) return;
    for (const std::string& reason : left_out_) console_.warn("left out: " + reason);
    if (num_used_ == 0) throw InputError(options_.folders.front() + ": no mesh could be used");
    if (options_.export_folder) {
      const auto path = boost::filesystem::path(*options_.export_folder) / "ground_truth.json";
      writeText(path.string(), nlohmann::json{{"clouds", ground_truth_}}.dump(1) + "\n");
    }
    report();
  }

private:
  /// Processes share the models.
  void evaluate(const std::vector<Model>& models) {
    Step step(console_, "Evaluating " + std::to_string(models.size()) + " models");
    const ReferenceCache known = cache_;  // not changed while other threads read it
    ModelEvaluation evaluation(options_, recipes_, known);
    std::vector<std::string> names;
    for (const Model& model : models) names.push_back(model.name);
    std::vector<ModelResult> results(models.size());
    std::size_t num_done = 0;
    work_.run(names, {[&](std::size_t i) { return packedResult(evaluation.evaluate(models[i]), recipes_); },
                      [&](std::size_t i, const std::string& packed) {
                        results[i] = unpackedResult(packed, recipes_);
                        keepReferences(models[i], results[i]);
                        step.progress(static_cast<double>(++num_done) / static_cast<double>(models.size()));
                      },
                      [&](std::size_t i) {
                        ModelResult lost;
                        lost.left_out.push_back(models[i].path + ": the processes that evaluated it died");
                        return packedResult(lost, recipes_);
                      }});
    if (!work_.isFirst()) return;
    for (ModelResult& result : results) add(result);
    cache_.save();
    step.done(std::to_string(num_used_) + " models, " + std::to_string(num_clouds_) + " clouds");
  }

  void keepReferences(const Model& model, ModelResult& result) {
    if (!result.found_references) return;
    cache_.add(model.key, result.num_faces, *result.found_references);
    result.found_references.reset();
    unsaved_ms_ += since_save_.lap();
    if (unsaved_ms_ < kSaveEvery) return;
    cache_.save();
    unsaved_ms_ = 0.0;
  }

  void add(ModelResult& result) {
    if (result.kind) ++num_models_[*result.kind];
    num_used_ += result.kind ? 1 : 0;
    num_clouds_ += result.num_clouds;
    left_out_.insert(left_out_.end(), result.left_out.begin(), result.left_out.end());
    results_.insert(results_.end(), result.clouds.begin(), result.clouds.end());
    if (!result.ground_truth.empty()) ground_truth_.update(nlohmann::json::parse(result.ground_truth));
  }

  void report() {
    std::printf("%d symmetric, %d nearly symmetric, %d asymmetric models\n", num_models_[SymmetryKind::Symmetric],
                num_models_[SymmetryKind::NearlySymmetric], num_models_[SymmetryKind::Asymmetric]);
    const std::vector<CloudGroup> groups = groupResults(results_, options_.clouds.sweep);
    if (!results_.empty()) {
      printDecisions(groups, options_.operating_point);
      printRankings(groups);
      printReliability(reliabilities(groups));
    }
    std::vector<std::string> failed;
    for (const CloudResult& result : results_)
      if (result.answers.failed) failed.push_back(result.cloud);
    for (const std::string& name : failed) console_.warn("no answer: " + name);
    if (options_.cloud_csv) writeText(*options_.cloud_csv, cloudCSV(results_));
    if (options_.model_csv) writeText(*options_.model_csv, modelCSV(results_));
    if (options_.reliability_csv) writeText(*options_.reliability_csv, reliabilityCSV(reliabilities(groups)));
    if (options_.share_csv) writeText(*options_.share_csv, shareCSV(reliabilities(groups)));
    if (options_.curve_csv) writeText(*options_.curve_csv, precisionRecallCSV(groups));
    if (options_.common.json_path) {
      const nlohmann::json summary{{"num_models",
                                    {{"symmetric", num_models_[SymmetryKind::Symmetric]},
                                     {"nearly_symmetric", num_models_[SymmetryKind::NearlySymmetric]},
                                     {"asymmetric", num_models_[SymmetryKind::Asymmetric]}}},
                                   {"left_out", left_out_},
                                   {"failed", failed},
                                   {"sweep", options_.sweep},
                                   {"seed", options_.common.seed},
                                   {"min_confidence", options_.operating_point.min_confidence},
                                   {"tolerance", options_.references.tolerance},
                                   {"tolerance_of", options_.tolerance_of},
                                   {"limits",
                                    {{"max_angle_deg", options_.limits.max_angle},
                                     {"max_axis_angle_deg", options_.limits.max_axis_angle},
                                     {"max_offset", options_.limits.max_offset}}},
                                   {"groups", toJson(groups)}};
      writeText(*options_.common.json_path, summary.dump(2) + "\n");
    }
    if (options_.png && !results_.empty()) drawChart(groups, options_.clouds.sweep, *options_.png);
  }

  const EvaluatePlanesOptions& options_;
  ResumableRun& work_;
  const Console console_;
  const std::vector<CloudRecipe> recipes_;
  ReferenceCache cache_;
  Stopwatch since_save_;
  double unsaved_ms_ = 0.0;  ///< since the references were last saved
  int num_used_ = 0, num_clouds_ = 0;
  std::map<SymmetryKind, int> num_models_;
  std::vector<std::string> left_out_;
  std::vector<CloudResult> results_;
  nlohmann::json ground_truth_ = nlohmann::json::object();
};

}  // namespace

int evaluatePlanes(int argc, char** argv, SharedWork& processes) {
  EvaluatePlanesOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  completeOptions(options, line);
  ResumableRun work(processes, options.journal, argc, argv);
  options.common.threads = options.references.num_threads = work.threadsOfItem(options.common.threads);
  PlanesEvaluation(options, work).run();
  return 0;
}

}  // namespace pcl_symmetry::apps
