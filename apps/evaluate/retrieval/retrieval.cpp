#include "evaluate/retrieval/retrieval.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/pictures/chart.h"
#include "common/scanner/virtual_scanner.h"
#include "common/shape_input/shape_input.h"
#include "common/shape_output/shape_output.h"
#include "core/base/parallel.h"
#include "evaluate/retrieval/retrieval_methods.h"
#include "evaluate/retrieval/retrieval_statistics.h"
#include "evaluate/shared/class_file.h"
#include "evaluate/shared/model_flags.h"
#include "evaluate/shared/model_list.h"
#include "evaluate/shared/table_text.h"
#include "pcl_symmetry/mesh_sampling.h"

namespace pcl_symmetry::apps {

namespace {

struct EvaluateRetrievalOptions {
  std::vector<std::string> folders;
  ModelSelection selection;
  std::optional<std::string> class_path;
  int num_points = 20'000;
  RetrievalOptions retrieval;
  bool database = false;
  std::optional<std::string> csv, class_csv, png;
  CommonOptions common;
};

CommandLine commandLine(EvaluateRetrievalOptions& o) {
  CommandLine line("pcl_symmetry_evaluate retrieval",
                   "Asks with each mesh for the others of its class (Section 5.2): by PRSD, PRST, GEDT and the product "
                   "of the latter two, each mesh in its own axes or turned at random and brought to the axes of its "
                   "symmetry or its principal axes, and by signatures. Says what symmetry brings.",
                   "pcl_symmetry_evaluate retrieval psb/train -cla psb/train.cla -csv recall.csv -png recall.png");
  addModelFlags(line, o.folders, o.selection);
  line.text("cla", "FILE", o.class_path,
            "classes of the meshes, in the format of the Princeton Shape Benchmark; required")
      .number("points", o.num_points, Range::closed(100, 10'000'000), "number of points spread over each mesh")
      .number("references", o.retrieval.num_references, Range::closed(3, 1'000'000),
              "number of meshes, of any class, that compact forms and scaled distances are made from")
      .number("nearest", o.retrieval.num_nearest, Range::closed(1, 1'000'000),
              "number of nearest references that scale distances")
      .flag("database", o.database, "only SymmetryDatabase::match(), each model turned at random")
      .text("csv", "FILE", o.csv, "precision at each recall, for each method")
      .text("class_csv", "FILE", o.class_csv, "a row for each class and method (Figure 14)")
      .picture("png", o.png,
               "precision against recall (Figure 13), NAME_files.png and NAME_turned.png; NAME_classes.png (Figure 14)")
      .common(o.common, kJson | kSeed | kThreads | kQuiet);
  return line;
}

constexpr std::size_t kNumPublished = 7;  // derived: rows of publishedMethods()

struct Result {
  RetrievalMethod method;
  RetrievalStatistics all;
};

class RetrievalEvaluation {
public:
  explicit RetrievalEvaluation(const EvaluateRetrievalOptions& options)
      : options_(options), console_(options.common.quiet) {}

  void run() {
    load();
    if (options_.database) {
      evaluate("Asking a database", [&](const auto& progress) {
        return std::vector{databaseMethod(clouds_, options_.retrieval, progress)};
      });
      return printTable();
    }
    evaluate("Describing models as they are",
             [&](const auto& progress) { return published(ModelAxes::AsGiven, progress); });
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
      const Eigen::Isometry3d pose = randomPose(options_.common.seed + 1 + i, 0.0);
      clouds_[i] = pose.linear().cast<float>() * clouds_[i];
    }
    evaluate("Describing models in the axes of their symmetry",
             [&](const auto& progress) { return published(ModelAxes::Symmetry, progress); });
    evaluate("Describing models in their principal axes",
             [&](const auto& progress) { return published(ModelAxes::Principal, progress); });
    evaluate("Comparing signatures",
             [&](const auto& progress) { return signatureMethods(clouds_, options_.retrieval, progress); });
    report();
  }

private:
  std::vector<RetrievalMethod> published(ModelAxes axes, const RetrievalProgress& progress) const {
    return publishedMethods(clouds_, axes, options_.retrieval, progress);
  }

  void load() {
    const std::map<std::string, std::string> class_of_models = readClassFile(*options_.class_path);
    std::vector<Model> models = listModels(options_.folders, options_.selection);
    models.erase(
        std::remove_if(models.begin(), models.end(), [&](const Model& m) { return !class_of_models.count(m.name); }),
        models.end());
    Step step(console_, "Loading " + std::to_string(models.size()) + " models");
    std::vector<Points> clouds(models.size());
    std::mutex mutex;
    parallelBlocks(models.size(), options_.common.threads, [&](std::size_t i) {
      try {
        const Shape shape = loadShape(models[i].path);
        if (!shape.mesh) throw InputError(models[i].path + ": has no faces");
        clouds[i] = sampleMesh(*shape.mesh, options_.num_points)->getMatrixXfMap(3, 4, 0);
      } catch (const std::exception& error) {
        const std::lock_guard<std::mutex> lock(mutex);
        left_out_.push_back(error.what());
      }
    });
    for (std::size_t i = 0; i < models.size(); ++i) {
      if (clouds[i].cols() == 0) continue;
      classes_.push_back(class_of_models.at(models[i].name));
      clouds_.push_back(std::move(clouds[i]));
    }
    step.done(std::to_string(clouds_.size()) + " models");
    std::sort(left_out_.begin(), left_out_.end());
    for (const std::string& reason : left_out_) console_.warn("left out: " + reason);
    if (clouds_.size() < 3) throw InputError(*options_.class_path + ": names fewer than 3 of the meshes");
  }

  template <typename Methods>
  void evaluate(const std::string& what, const Methods& methods) {
    Step step(console_, what);
    std::mutex mutex;
    for (RetrievalMethod& method : methods([&](double share) {
           const std::lock_guard<std::mutex> lock(mutex);
           step.progress(share);
         })) {
      RetrievalStatistics all = retrievalStatistics(method.distances, classes_);
      results_.push_back({std::move(method), std::move(all)});
    }
    step.done();
  }

  void report() const {
    if (results_.front().all.num_queries == 0)
      throw InputError(*options_.class_path + ": no class holds two of the meshes");
    printTable();
    printWhatSymmetryBrings();
    printGains();
    if (options_.csv) writeText(*options_.csv, curves());
    if (options_.class_csv) writeText(*options_.class_csv, classTable());
    if (options_.common.json_path) writeText(*options_.common.json_path, summary().dump(2) + "\n");
    if (options_.png) draw();
  }

  void printTable() const {
    std::printf("%-40s %8s %8s %8s %8s %8s   of %d queries, per cent\n", "", "nearest", "tier 1", "tier 2", "E", "DCG",
                results_.front().all.num_queries);
    for (const Result& r : results_)
      std::printf("%-40s %8.1f %8.1f %8.1f %8.1f %8.1f\n", r.method.name.c_str(), 100.0 * r.all.nearest,
                  100.0 * r.all.first_tier, 100.0 * r.all.second_tier, 100.0 * r.all.e_measure, 100.0 * r.all.dcg);
  }

  /// Pairs of methods that differ in the use of symmetry alone.
  void printWhatSymmetryBrings() const {
    const std::vector<std::array<std::string, 2>> pairs = {
        {"PRST x GEDT, axes of the files", "GEDT, axes of the files"},
        {"PRST by equation 1 x GEDT, axes of the files", "GEDT, axes of the files"},
        {"PRST x GEDT, symmetry axes", "GEDT, symmetry axes"},
        {"PRST by equation 1 x GEDT, symmetry axes", "GEDT, symmetry axes"},
        {"GEDT, symmetry axes", "GEDT, principal axes"},
        {"PRST x GEDT, all turns", "GEDT, all turns"},
        {"compact PRST x GEDT", "compact GEDT"},
        {"compact PRST x GEDT, scaled", "compact GEDT, scaled"}};
    std::printf("\n%-58s %-24s %-24s   what symmetry brings, points\n", "", "nearest", "DCG");
    for (const auto& [with, without] : pairs) {
      const QueryScores a = scoresOf(with), b = scoresOf(without);
      const Gain nearest = pairedGain(a.nearest, b.nearest, a.classes), dcg = pairedGain(a.dcg, b.dcg, a.classes);
      std::printf("%-58s %+5.1f (%+5.1f to %+5.1f)   %+5.1f (%+5.1f to %+5.1f)\n", (with + " - " + without).c_str(),
                  100.0 * nearest.mean, 100.0 * nearest.low, 100.0 * nearest.high, 100.0 * dcg.mean, 100.0 * dcg.low,
                  100.0 * dcg.high);
    }
  }

  QueryScores scoresOf(const std::string& name) const {
    const auto found = std::find_if(results_.begin(), results_.end(),
                                    [&](const Result& result) { return result.method.name == name; });
    return queryScores(found->method.distances, classes_);
  }

  struct ClassGain {
    std::string name;
    double prst, gedt, product;  ///< discounted cumulative gain in the axes of the files
    Gain ahead;                  ///< of PRST over GEDT, interval over the queries
  };

  /// The gain of the queries of one class, each drawn by itself.
  static Gain gainWithin(const std::string& name, const QueryScores& with, const QueryScores& without) {
    std::vector<double> a, b;
    std::vector<std::string> queries;
    for (std::size_t i = 0; i < with.classes.size(); ++i) {
      if (with.classes[i] != name) continue;
      a.push_back(with.dcg[i]);
      b.push_back(without.dcg[i]);
      queries.push_back(std::to_string(i));
    }
    return pairedGain(a, b, queries);
  }

  /// First those that PRST finds best compared with GEDT.
  std::vector<ClassGain> classGains() const {
    const auto prst = statisticsByClass(results_[1].method.distances, classes_);
    const auto gedt = statisticsByClass(results_[2].method.distances, classes_);
    const auto product = statisticsByClass(results_[3].method.distances, classes_);
    std::vector<ClassGain> gains;
    const QueryScores of_prst = queryScores(results_[1].method.distances, classes_);
    const QueryScores of_gedt = queryScores(results_[2].method.distances, classes_);
    for (const auto& [name, statistics] : prst)
      gains.push_back(
          {name, statistics.dcg, gedt.at(name).dcg, product.at(name).dcg, gainWithin(name, of_prst, of_gedt)});
    std::stable_sort(gains.begin(), gains.end(),
                     [](const ClassGain& a, const ClassGain& b) { return a.prst - a.gedt > b.prst - b.gedt; });
    return gains;
  }

  /// The classes that PRST finds better than GEDT and the other way round, as the paper's Figure 14 has them.
  void printGains() const {
    constexpr std::size_t kShown = 5;  // derived: Figure 14 shows five classes at either end
    const std::vector<ClassGain> gains = classGains();
    std::printf("\n%-44s %8s %8s %8s   DCG, %s\n", "", "PRST", "GEDT", "product", "axes of the files");
    for (std::size_t i = 0; i < gains.size(); ++i) {
      if (i >= kShown && i + kShown < gains.size()) continue;
      std::printf("%-44s %8.1f %8.1f %8.1f\n", gains[i].name.c_str(), 100.0 * gains[i].prst, 100.0 * gains[i].gedt,
                  100.0 * gains[i].product);
    }
  }

  std::string curves() const {
    std::string text = Row().add("method").add("recall").add("precision").end();
    for (const Result& r : results_)
      for (int k = 0; k < kNumRecalls; ++k)
        text += Row()
                    .add(r.method.name)
                    .add((k + 1.0) / kNumRecalls)
                    .add(r.all.precision[static_cast<std::size_t>(k)])
                    .end();
    return text;
  }

  std::string classTable() const {
    Row head;
    for (const char* title : {"class", "models", "method", "nearest", "first_tier", "second_tier", "e_measure", "dcg"})
      head.add(title);
    std::string text = head.end();
    for (const Result& r : results_)
      for (const auto& [name, s] : statisticsByClass(r.method.distances, classes_))
        text += Row()
                    .add(name)
                    .add(s.num_queries)
                    .add(r.method.name)
                    .add(s.nearest)
                    .add(s.first_tier)
                    .add(s.second_tier)
                    .add(s.e_measure)
                    .add(s.dcg)
                    .end();
    return text;
  }

  nlohmann::json summary() const {
    nlohmann::json methods = nlohmann::json::object();
    for (const Result& r : results_)
      methods[r.method.name] = {{"nearest", r.all.nearest},
                                {"first_tier", r.all.first_tier},
                                {"second_tier", r.all.second_tier},
                                {"e_measure", r.all.e_measure},
                                {"dcg", r.all.dcg},
                                {"precision", r.all.precision}};
    return {{"num_queries", results_.front().all.num_queries},
            {"references", options_.retrieval.num_references},
            {"seed", options_.common.seed},
            {"left_out", left_out_},
            {"methods", methods}};
  }

  void draw() const {
    drawCurves("Precision against recall, axes of the files", 0, kNumPublished, "_files");
    drawCurves("Precision against recall, models turned at random", kNumPublished, results_.size(), "_turned");
    drawClasses();
  }

  /// Figure 13 with bands of 95 % intervals over classes: no more curves than there are colours, eight.
  void drawCurves(const std::string& title, std::size_t begin, std::size_t end, const std::string& what) const {
    Chart chart;
    chart.title = title;
    chart.x = {"recall", false, std::make_pair(0.0, 1.0)};
    chart.y = {"precision", false, std::make_pair(0.0, 1.0)};
    for (std::size_t i = begin; i < end; ++i) {
      const Result& r = results_[i];
      if (!r.method.charted) continue;
      ChartSeries series{r.method.name, {}, r.all.precision, false};
      const QueryScores scores = queryScores(r.method.distances, classes_);
      for (int k = 0; k < kNumRecalls; ++k) {
        const std::vector<double>& precision = scores.precision[static_cast<std::size_t>(k)];
        const Gain of_none = pairedGain(precision, std::vector<double>(precision.size(), 0.0), scores.classes);
        series.x.push_back((k + 1.0) / kNumRecalls);
        series.low.push_back(of_none.low);
        series.high.push_back(of_none.high);
      }
      chart.series.push_back(std::move(series));
    }
    writeChart(chart, chartBeside(*options_.png, what));
  }

  /// Figure 14: class by class, with the 95 % intervals of PRST.
  void drawClasses() const {
    Chart chart;
    chart.title = "Classes, axes of the files";
    chart.x.title = "rank of the class, by what PRST gains over GEDT";
    chart.y.title = "discounted cumulative gain, less that of GEDT";
    chart.series = {{"PRST", {}, {}, true}, {"PRST x GEDT", {}, {}, true}, {"GEDT", {}, {}, false, true}};
    for (const ClassGain& gain : classGains()) {
      for (ChartSeries& series : chart.series) series.x.push_back(1.0 + static_cast<double>(series.x.size()));
      chart.series[0].y.push_back(gain.prst - gain.gedt);
      chart.series[0].low.push_back(gain.ahead.low);
      chart.series[0].high.push_back(gain.ahead.high);
      chart.series[1].y.push_back(gain.product - gain.gedt);
      chart.series[2].y.push_back(0.0);
    }
    writeChart(chart, chartBeside(*options_.png, "_classes"));
  }

  const EvaluateRetrievalOptions& options_;
  const Console console_;
  std::vector<Points> clouds_;
  std::vector<std::string> classes_, left_out_;
  std::vector<Result> results_;
};

}  // namespace

int evaluateRetrieval(int argc, char** argv) {
  EvaluateRetrievalOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (!options.class_path) throw UsageError("missing flag '-cla FILE'");
  options.retrieval.seed = options.common.seed;
  options.retrieval.num_threads = options.common.threads;
  RetrievalEvaluation(options).run();
  return 0;
}

}  // namespace pcl_symmetry::apps
