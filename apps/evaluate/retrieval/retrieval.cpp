#include "evaluate/retrieval/retrieval.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
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
#include "evaluate/runs/resumable_run.h"
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
  std::optional<std::string> csv, class_csv, png, journal;
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
      .picture(
          "png", o.png,
          "precision against recall (Figure 13), NAME_files.png and NAME_turned.png; NAME_classes.png (Figure 14)");
  ResumableRun::addFlag(line, o.journal);
  line.common(o.common, kJson | kSeed | kThreads | kQuiet);
  return line;
}

constexpr std::size_t kNumPublished = 7;  // derived: rows of publishedMethods()

struct Result {
  RetrievalMethod method;
  RetrievalStatistics all;
};

class RetrievalEvaluation {
public:
  RetrievalEvaluation(const EvaluateRetrievalOptions& options, ResumableRun& work)
      : options_(options), work_(work), console_(options.common.quiet || !work.isFirst()) {}

  void run() {
    if (options_.database && options_.png) throw UsageError("-png draws the published descriptors, not -database");
    select();
    if (options_.database) return askDatabase();
    for (const ModelAxes axes : {ModelAxes::AsGiven, ModelAxes::Symmetry, ModelAxes::Principal}) {
      const auto models =
          described<SymmetryDescriptors>("in the " + nameOf(axes), axes != ModelAxes::AsGiven,
                                         [&](const Points& cloud) { return publishedForms(cloud, axes); });
      if (axes == ModelAxes::AsGiven) leaveOut();
      if (work_.isFirst()) add(publishedMethods(models, axes, options_.retrieval));
    }
    auto models = described<TurnableForms>("by signatures", true, turnableForms);
    if (!work_.isFirst()) return;
    compare("Comparing signatures",
            [&](const auto& progress) { return signatureMethods(std::move(models), options_.retrieval, progress); });
    report();
  }

private:
  void select() {
    const std::map<std::string, std::string> class_of_models = readClassFile(*options_.class_path);
    for (const Model& model : listModels(options_.folders, options_.selection)) {
      const auto found = class_of_models.find(model.name);
      if (found == class_of_models.end()) continue;
      models_.push_back(model);
      classes_.push_back(found->second);
    }
    reasons_.resize(models_.size());
  }

  Points cloudOf(std::size_t i) const {
    const Shape shape = loadShape(models_[i].path);
    if (!shape.mesh) throw InputError(models_[i].path + ": has no faces");
    return sampleMesh(*shape.mesh, options_.num_points)->getMatrixXfMap(3, 4, 0);
  }

  Points turnedCloudOf(std::size_t i) const {
    const Eigen::Isometry3d pose = randomPose(options_.common.seed + 1 + i, 0.0);
    return pose.linear().cast<float>() * cloudOf(i);
  }

  /// Processes share the models.
  /// \return one for each model; where a model cannot be used, reasons_ say so, and its place is kept until leaveOut().
  template <typename Forms>
  std::vector<Forms> described(const std::string& how, bool turned,
                               const std::function<Forms(const Points&)>& describe) {
    constexpr char kDone = 'd', kFailed = 'f';  // chosen: the first letters
    Step step(console_, "Describing " + std::to_string(models_.size()) + " models " + how);
    std::vector<std::string> names;
    for (const Model& model : models_) names.push_back(how + " " + model.name);
    std::vector<Forms> forms(models_.size());
    std::size_t num_done = 0;
    const auto work = [&](std::size_t i) {
      try {
        return kDone + packed(describe(turned ? turnedCloudOf(i) : cloudOf(i)));
      } catch (const std::exception& error) {
        return kFailed + std::string(error.what());
      }
    };
    const auto take = [&](std::size_t i, const std::string& result) {
      if (result.front() == kDone)
        unpack(result.substr(1), forms[i]);
      else
        reasons_[i] = result.substr(1);
      step.progress(static_cast<double>(++num_done) / static_cast<double>(models_.size()));
    };
    const auto lost = [&](std::size_t i) {
      return kFailed + models_[i].path + ": the processes that described it died";
    };
    work_.run(names, {work, take, lost}, options_.common.threads);
    if (!work_.isFirst()) return {};
    if (turned) checkAll();
    removeUnused(forms);
    step.done(std::to_string(forms.size()) + " models");
    return forms;
  }

  /// What could be read once can be read again.
  void checkAll() const {
    for (const std::string& reason : reasons_)
      if (!reason.empty()) throw InputError(reason);
  }

  template <typename Value>
  void removeUnused(std::vector<Value>& values) const {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (reasons_[i].empty() && kept++ != i) values[kept - 1] = std::move(values[i]);
    values.resize(kept);
  }

  /// Models that cannot be used: all processes go on without them.
  void leaveOut() {
    std::string unused;
    for (const std::string& reason : reasons_) unused += reason.empty() ? '0' : '1';
    work_.broadcast(unused);
    for (std::size_t i = 0; i < reasons_.size(); ++i) {
      if (unused[i] == '1' && reasons_[i].empty()) reasons_[i] = "left out";  // the first process knows why
      if (unused[i] == '1') left_out_.push_back(reasons_[i]);
    }
    removeUnused(models_);
    removeUnused(classes_);
    reasons_.assign(models_.size(), "");
    std::sort(left_out_.begin(), left_out_.end());
    for (const std::string& reason : left_out_) console_.warn("left out: " + reason);
    if (models_.size() < 3) throw InputError(*options_.class_path + ": names fewer than 3 of the meshes");
  }

  /// By this process alone.
  void askDatabase() {
    std::vector<Points> clouds(models_.size());
    {
      Step step(console_, "Loading " + std::to_string(models_.size()) + " models");
      parallelBlocks(models_.size(), options_.common.threads, [&](std::size_t i) {
        try {
          clouds[i] = cloudOf(i);
        } catch (const std::exception& error) {
          reasons_[i] = error.what();
        }
      });
      removeUnused(clouds);
      step.done(std::to_string(clouds.size()) + " models");
    }
    leaveOut();
    compare("Asking a database",
            [&](const auto& progress) { return std::vector{databaseMethod(clouds, options_.retrieval, progress)}; });
    report();
  }

  template <typename Methods>
  void compare(const std::string& what, const Methods& methods) {
    Step step(console_, what);
    std::mutex mutex;
    add(methods([&](double share) {
      const std::lock_guard<std::mutex> lock(mutex);
      step.progress(share);
    }));
    step.done();
  }

  void add(std::vector<RetrievalMethod> methods) {
    for (RetrievalMethod& method : methods) {
      RetrievalStatistics all = retrievalStatistics(method.distances, classes_);
      results_.push_back({std::move(method), std::move(all)});
    }
  }

  void report() const {
    if (results_.front().all.num_queries == 0)
      throw InputError(*options_.class_path + ": no class holds two of the meshes");
    printTable();
    if (!options_.database) {
      printWhatSymmetryBrings();
      printGains();
    }
    if (options_.csv) writeText(*options_.csv, curves());
    if (options_.class_csv) writeText(*options_.class_csv, classTable());
    if (options_.common.json_path) writeText(*options_.common.json_path, summary().dump(2) + "\n");
    if (options_.png && !options_.database) draw();
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
  ResumableRun& work_;
  const Console console_;
  std::vector<Model> models_;
  std::vector<std::string> classes_;  ///< of the models
  std::vector<std::string> reasons_;  ///< why a model cannot be used, or nothing
  std::vector<std::string> left_out_;
  std::vector<Result> results_;
};

}  // namespace

int evaluateRetrieval(int argc, char** argv, SharedWork& processes) {
  EvaluateRetrievalOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  if (!options.class_path) throw UsageError("missing flag '-cla FILE'");
  options.retrieval.seed = options.common.seed;
  options.retrieval.num_threads = options.common.threads;
  if (options.database && processes.isShared())
    throw UsageError("-database is for one process: start it without mpirun");
  ResumableRun work(processes, options.journal, argc, argv);
  RetrievalEvaluation(options, work).run();
  return 0;
}

}  // namespace pcl_symmetry::apps
