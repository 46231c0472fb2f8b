#include "evaluate/segmentation/segmentation.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <limits>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/files/file_text.h"
#include "common/shape_input/shape_input.h"
#include "common/shape_output/face_labels.h"
#include "common/shape_output/shape_output.h"
#include "evaluate/people/segment_files.h"
#include "evaluate/references/reference_symmetries.h"
#include "evaluate/runs/packed_rows.h"
#include "evaluate/segmentation/mirror_agreement.h"
#include "evaluate/segmentation/segmentation_methods.h"
#include "evaluate/segmentation/segmentation_report.h"
#include "evaluate/shared/model_flags.h"
#include "evaluate/shared/model_list.h"
#include "pcl_symmetry/symmetry_segmentation.h"

namespace pcl_symmetry::apps {

namespace fs = boost::filesystem;

namespace {

// Points that the reference planes are measured with. derived: the standard error of a share of 0.97 is then 0.002.
constexpr int kReferenceSamples = 5000;
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();  // derived: the value that is no distance

struct EvaluateSegmentationOptions {
  std::string meshes, references;
  ModelSelection selection;
  std::vector<double> remainders;
  int modulus = 4;
  std::optional<std::string> methods, segments_folder, csv, journal;
  bool categories = false, mirrored = false;
  CommonOptions common;
};

CommandLine commandLine(EvaluateSegmentationOptions& o) {
  CommandLine line("pcl_symmetry_evaluate segmentation",
                   "Measures how far segmentations of meshes are from those that people made (Princeton Segmentation "
                   "Benchmark), and how far people are from each other.",
                   "pcl_symmetry_evaluate segmentation psb/off psb/seg/Benchmark -remainders 1,3 -categories");
  line.positional("meshes", o.meshes, "folder of .off, .ply, .obj and .stl meshes, 12.off ...")
      .positional("references", o.references, "folder of .seg files: 12/12_0.seg, or 12_0.seg, ...")
      .numbers("remainders", o.remainders, Range::closed(0, 1'000'000),
               "only names that are numbers and leave these remainders by -modulus")
      .number("modulus", o.modulus, Range::closed(1, 1'000'000), "for -remainders")
      .text("methods", "A,B,...", o.methods,
            "human, one, k-means; Section 5.3: paper-1 to paper-4 (by depth), letter-1 to letter-4 (to the letter); "
            "merging by evidence: nothing, symmetry, concavity, no-symmetry, all; all, but one step: one-division, "
            "no-agreement, no-cut; points (a cloud of the mesh) (human,one,k-means,all)")
      .text("segments", "DIR", o.segments_folder, "also judge 12.seg ... that another program wrote")
      .flag("categories", o.categories, "Rand distance by category of the benchmark")
      .flag("mirrored", o.mirrored, "also share of the area that agrees with its mirror image, seconds a model")
      .text("csv", "FILE", o.csv, "a row for each method and model")
      .common(o.common, kJson | kThreads | kQuiet);
  ResumableRun::addFlag(line, o.journal);
  addSelectionFlags(line, o.selection);
  return line;
}

bool leavesRemainder(const std::string& name, const std::vector<double>& remainders, int modulus) {
  std::uint64_t number = 0;
  if (!spellsCount(name, &number)) return false;
  const auto remainder = static_cast<double>(number % static_cast<std::uint64_t>(modulus));
  return std::find(remainders.begin(), remainders.end(), remainder) != remainders.end();
}

/// Mean over what several people made; values that are not defined for one of them do not count.
class MeanDistance {
public:
  void add(const SegmentationDistance& d) {
    for (std::size_t k = 0; k < std::size(kValues); ++k) {
      if (!std::isfinite(d.*kValues[k])) continue;
      sums_[k] += d.*kValues[k];
      ++counts_[k];
    }
  }
  SegmentationDistance mean() const {
    SegmentationDistance d;
    for (std::size_t k = 0; k < std::size(kValues); ++k)
      d.*kValues[k] = counts_[k] > 0 ? sums_[k] / counts_[k] : std::numeric_limits<double>::quiet_NaN();
    return d;
  }

private:
  // derived: all distances.
  static constexpr double SegmentationDistance::*kValues[] = {&SegmentationDistance::rand,
                                                              &SegmentationDistance::cut_discrepancy,
                                                              &SegmentationDistance::hamming,
                                                              &SegmentationDistance::hamming_missing,
                                                              &SegmentationDistance::hamming_false,
                                                              &SegmentationDistance::global_consistency,
                                                              &SegmentationDistance::local_consistency};
  double sums_[std::size(kValues)] = {};
  int counts_[std::size(kValues)] = {};
};

double smallestShare(const PreparedSegmentation& segmentation) {
  std::vector<int> sizes(segmentation.num_segments, 0);
  for (const int label : segmentation.labels) ++sizes[label];
  const int smallest = sizes.empty() ? 0 : *std::min_element(sizes.begin(), sizes.end());
  return static_cast<double>(smallest) / static_cast<double>(std::max<std::size_t>(1, segmentation.labels.size()));
}

class SegmentationEvaluation {
public:
  SegmentationEvaluation(const EvaluateSegmentationOptions& options, ResumableRun& work)
      : options_(options), work_(work), console_(options.common.quiet || !work.isFirst()) {
    std::vector<std::string> names = {"human", "one", "k-means", "all"};
    if (options.methods) boost::split(names, *options.methods, boost::is_any_of(","));
    const auto human = std::find(names.begin(), names.end(), "human");
    people_ = human != names.end();
    if (people_) names.erase(human);
    methods_ = segmentationMethods(names, options.common.threads);
  }

  void run() {
    std::vector<Model> models = listModels({options_.meshes}, options_.selection);
    if (!options_.remainders.empty()) {
      models.erase(std::remove_if(
                       models.begin(), models.end(),
                       [&](const Model& m) { return !leavesRemainder(m.name, options_.remainders, options_.modulus); }),
                   models.end());
      if (models.empty()) throw InputError(options_.meshes + ": no mesh is selected by -remainders");
    }
    Step step(console_, "Evaluating " + std::to_string(models.size()) + " models");
    const std::vector<ItemRows<SegmentationResult>> all = rowsOfModels<SegmentationResult>(
        models, [&](const Model& model) { return evaluate(model); }, work_, step);
    if (!work_.isFirst()) return;
    step.done();
    for (const ItemRows<SegmentationResult>& item : all) {
      results_.insert(results_.end(), item.rows.begin(), item.rows.end());
      if (!item.left_out.empty()) console_.warn("left out: " + item.left_out);
    }
    std::stable_sort(results_.begin(), results_.end(),
                     [&](const auto& a, const auto& b) { return rank(a.method) < rank(b.method); });
    report();
  }

private:
  ItemRows<SegmentationResult> evaluate(const Model& model) const {
    const Shape shape = loadShape(model.path);
    if (!shape.mesh) throw InputError(model.path + ": has no faces");
    const SegmentationComparison comparison(*shape.mesh);
    std::vector<PreparedSegmentation> references;
    for (const std::string& path : segmentFilesOf(options_.references, model.name))
      references.push_back(prepare(comparison, path, readFaceLabels(path)));
    if (references.empty()) return {{}, model.path + ": no .seg file in " + options_.references};
    std::vector<SegmentationResult> rows;
    const std::optional<Mirror> mirror = options_.mirrored ? mirrorOf(*shape.mesh) : std::nullopt;
    if (people_ && references.size() > 1) rows.push_back(ofPeople(model, comparison, references, mirror));
    for (const NamedSegmentation& method : methods_) {
      Stopwatch watch;
      const Segmentation segmentation = method.segment(*shape.mesh);
      const double ms = watch.lap();
      rows.push_back(resultOf(method.name, model, comparison, references,
                              prepare(comparison, method.name, segmentation.labels), ms));
      rows.back().mirror_agreement = agreementAcross(mirror, segmentation.labels);
    }
    if (options_.segments_folder) {
      const std::string path = (fs::path(*options_.segments_folder) / (model.name + ".seg")).string();
      rows.push_back(
          resultOf("-segments", model, comparison, references, prepare(comparison, path, readFaceLabels(path)), 0.0));
    }
    return {std::move(rows), ""};
  }

  /// A mesh and the plane that maps it onto itself, from the search of references.
  struct Mirror {
    SurfaceGraph graph;
    ReflectionPlane plane;
  };

  std::optional<Mirror> mirrorOf(const pcl::PolygonMesh& mesh) const {
    ReferenceOptions search;
    search.num_samples = kReferenceSamples;
    search.num_threads = options_.common.threads;
    const ReferenceSymmetries references = findReferenceSymmetries(mesh, search);
    if (references.planes.empty()) return std::nullopt;
    return Mirror{meshGraph(mesh), references.planes.front().plane};
  }

  static double agreementAcross(const std::optional<Mirror>& mirror, const std::vector<int>& labels) {
    return mirror ? mirrorAgreement(mirror->graph, labels, mirror->plane) : kUndefined;
  }

  static PreparedSegmentation prepare(const SegmentationComparison& comparison, const std::string& name,
                                      const std::vector<int>& labels) {
    try {
      return comparison.prepare(labels);
    } catch (const std::invalid_argument& error) {
      throw InputError(name + ": " + error.what());
    }
  }

  static SegmentationResult ofPeople(const Model& model, const SegmentationComparison& comparison,
                                     const std::vector<PreparedSegmentation>& people,
                                     const std::optional<Mirror>& mirror) {
    MeanDistance mean;
    double num_segments = 0.0, smallest = 0.0, agreement = 0.0;
    for (std::size_t i = 0; i < people.size(); ++i) {
      for (std::size_t j = 0; j < people.size(); ++j)
        if (i != j) mean.add(comparison.compare(people[i], people[j]));
      num_segments += people[i].num_segments;
      smallest += smallestShare(people[i]);
      agreement += agreementAcross(mirror, people[i].labels);
    }
    const auto count = static_cast<double>(people.size());
    return {"human",
            model.name,
            benchmarkCategory(model.name),
            mean.mean(),
            num_segments / count,
            smallest / count,
            agreement / count,
            kUndefined};
  }

  static SegmentationResult resultOf(const std::string& method, const Model& model,
                                     const SegmentationComparison& comparison,
                                     const std::vector<PreparedSegmentation>& references,
                                     const PreparedSegmentation& segmentation, double ms) {
    MeanDistance mean;
    for (const PreparedSegmentation& reference : references) mean.add(comparison.compare(reference, segmentation));
    return {method,
            model.name,
            benchmarkCategory(model.name),
            mean.mean(),
            static_cast<double>(segmentation.num_segments),
            smallestShare(segmentation),
            kUndefined,
            ms};
  }

  std::size_t rank(const std::string& method) const {
    if (method == "human") return 0;
    const auto found =
        std::find_if(methods_.begin(), methods_.end(), [&](const NamedSegmentation& m) { return m.name == method; });
    return 1 + static_cast<std::size_t>(found - methods_.begin());
  }

  void report() const {
    if (results_.empty()) throw InputError(options_.references + ": no .seg file belongs to a mesh");
    printTable(results_, options_.categories);
    if (options_.csv) writeText(*options_.csv, segmentationCSV(results_));
    if (options_.common.json_path) writeText(*options_.common.json_path, toJson(results_).dump(2) + "\n");
  }

  const EvaluateSegmentationOptions& options_;
  ResumableRun& work_;
  const Console console_;
  bool people_ = false;
  std::vector<NamedSegmentation> methods_;
  std::vector<SegmentationResult> results_;
};

}  // namespace

int evaluateSegmentation(int argc, char** argv, SharedWork& processes) {
  EvaluateSegmentationOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  ResumableRun work(processes, options.journal, argc, argv);
  options.common.threads = work.threadsOfItem(options.common.threads);
  SegmentationEvaluation(options, work).run();
  return 0;
}

}  // namespace pcl_symmetry::apps
