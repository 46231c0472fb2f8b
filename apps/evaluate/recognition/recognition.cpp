#include "evaluate/recognition/recognition.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/shape_input/shape_input.h"
#include "common/shape_output/shape_output.h"
#include "evaluate/clouds/test_clouds.h"
#include "evaluate/runs/packed_rows.h"
#include "evaluate/runs/shared_database.h"
#include "evaluate/shared/class_file.h"
#include "evaluate/shared/model_flags.h"
#include "evaluate/shared/model_list.h"
#include "evaluate/shared/table_text.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/recognition/symmetry_database.h"

namespace pcl_symmetry::apps {

namespace {

struct EvaluateRecognitionOptions {
  std::vector<std::string> folders;
  ModelSelection selection;
  std::optional<std::string> class_path, csv, journal;
  int num_points = 10'000, leave_out = 10, query_every = 1;
  double noise = 0.0;
  RecognitionOptions recognition;
  CommonOptions common;
};

CommandLine commandLine(EvaluateRecognitionOptions& o) {
  CommandLine line("pcl_symmetry_evaluate recognition",
                   "Scans each mesh once, from a direction and in a pose drawn at random, and asks a database of all "
                   "meshes but some which of them it is.",
                   "pcl_symmetry_evaluate recognition psb/train -cla psb/train.cla -csv queries.csv");
  addModelFlags(line, o.folders, o.selection);
  line.text("cla", "FILE", o.class_path, "only the models of this classification of the Princeton Shape Benchmark")
      .number("leave_out", o.leave_out, Range::closed(2, 1'000'000), "leave every N-th mesh out of the database")
      .number("query_every", o.query_every, Range::closed(1, 1'000'000), "scan every N-th mesh of the database only")
      .number("points", o.num_points, Range::closed(100, 10'000'000), "number of points per scan")
      .number("noise", o.noise, Range::closed(0, 1), "standard deviation of the depth, in diagonals")
      .number("candidates", o.recognition.num_candidates, Range::closed(1, 1'000'000),
              "number of models that are brought to a scan first")
      .number("max_candidates", o.recognition.max_candidates, Range::closed(1, 1'000'000),
              "number of models that are tried until one is accepted")
      .number("min_confidence", o.recognition.min_confidence, Range::closed(0, 1), "least confidence of a known model")
      .number("min_merit", o.recognition.min_merit, Range::closed(-1, 1), "least merit of the pose of a known model")
      .text("csv", "FILE", o.csv, "a row for each scan")
      .common(o.common, kJson | kSeed | kThreads | kQuiet);
  ResumableRun::addFlag(line, o.journal);
  return line;
}

struct Query {
  std::string model, answer;  ///< the answer is empty where the object is said to be unknown
  bool known = false;         ///< the model is in the database
  bool same_class = false;
  double merit = 0.0, milliseconds = 0.0;
};

void put(detail::PackedBytes& bytes, const Query& query) {
  bytes.putText(query.model);
  bytes.putText(query.answer);
  for (const bool is : {query.known, query.same_class}) bytes.put(is);
  for (const double number : {query.merit, query.milliseconds}) bytes.put(number);
}

void get(detail::UnpackedBytes& bytes, Query& query) {
  query.model = bytes.text();
  query.answer = bytes.text();
  for (bool* is : {&query.known, &query.same_class}) *is = bytes.get<bool>();
  for (double* number : {&query.merit, &query.milliseconds}) *number = bytes.get<double>();
}

class RecognitionEvaluation {
public:
  RecognitionEvaluation(const EvaluateRecognitionOptions& options, ResumableRun& work)
      : options_(options), work_(work), console_(options.common.quiet || !work.isFirst()) {}

  void run() {
    list();
    build();
    std::vector<Model> asked;
    std::set<std::string> unknown;
    for (std::size_t i = 0; i < models_.size(); ++i) {
      if (isLeftOut(i)) unknown.insert(models_[i].key);
      if (isLeftOut(i) || i % static_cast<std::size_t>(options_.query_every) == 0) asked.push_back(models_[i]);
    }
    Step step(console_, "Recognizing scans");
    queries_ =
        joinedRows(rowsOfModels<Query>(
                       asked, [&](const Model& model) { return ask(model, !unknown.count(model.key)); }, work_, step),
                   left_out_);
    if (!work_.isFirst()) return;
    step.done(std::to_string(queries_.size()) + " scans");
    for (const std::string& reason : left_out_) console_.warn("left out: " + reason);
    if (queries_.empty()) throw InputError(options_.folders.front() + ": no mesh could be used");
    report();
  }

private:
  void list() {
    models_ = listModels(options_.folders, options_.selection);
    if (!options_.class_path) return;
    classes_ = readClassFile(*options_.class_path);
    models_.erase(
        std::remove_if(models_.begin(), models_.end(), [&](const Model& model) { return !classes_.count(model.name); }),
        models_.end());
  }

  bool isLeftOut(std::size_t i) const {
    return i % static_cast<std::size_t>(options_.leave_out) == static_cast<std::size_t>(options_.leave_out) - 1;
  }

  void build() {
    Step step(console_, "Building a database");
    std::vector<ModelInput> inputs;
    std::map<std::string, std::string> paths;  // by name
    for (std::size_t i = 0; i < models_.size(); ++i) {
      if (isLeftOut(i)) continue;
      const Model& model = models_[i];
      paths[model.name] = model.path;
      inputs.push_back({model.name, {}, [&model, this] {
                          const Shape shape = loadShape(model.path);
                          if (!shape.mesh) throw InputError("has no faces");
                          return *sampleMesh(*shape.mesh, 20'000, options_.common.seed + 1);
                        }});
    }
    DatabaseOptions options;
    options.num_threads = options_.common.threads;
    database_.emplace(inputs, options, work_, [&](double share) { step.progress(share); });
    for (const auto& [name, reason] : database_->failures()) left_out_.push_back(paths[name] + ": " + reason);
    step.done(std::to_string((*database_)->size()) + " models");
  }

  ItemRows<Query> ask(const Model& model, bool known) const {
    try {
      if (known && !(*database_)->contains(model.name)) return {};
      return {{queryOf(model, known)}, ""};
    } catch (const std::exception& error) {
      return {{}, model.path + ": " + error.what()};
    }
  }

  Query queryOf(const Model& model, bool known) const {
    TestCloudOptions clouds;
    clouds.num_points = options_.num_points;
    clouds.noise.clear();
    clouds.scan_noise = {options_.noise};
    clouds.random_views = true;
    clouds.num_views = 1;
    clouds.seed = options_.common.seed;
    const TestCloud scan =
        TestCloudMaker(*loadShape(model.path).mesh, model.key, clouds).make(recipesFor(clouds).front());
    RecognitionOptions recognition = options_.recognition;
    recognition.num_threads = options_.common.threads;
    Stopwatch watch;
    const Recognition found = (*database_)->recognize(*scan.cloud, recognition);
    Query query{model.name, "", known, false, 0.0, watch.lap()};
    if (found.empty()) return query;
    query.answer = found.front().name;
    query.merit = found.front().score.merit();
    query.same_class = query.answer == model.name || classOf(query.answer) == classOf(model.name);
    return query;
  }

  /// Without classes each model is one of its own.
  std::string classOf(const std::string& model) const {
    const auto found = classes_.find(model);
    return found == classes_.end() ? model : found->second;
  }

  template <typename Condition>
  double share(bool known, const Condition& condition) const {
    int count = 0, fulfilled = 0;
    for (const Query& query : queries_) {
      if (query.known != known) continue;
      ++count;
      fulfilled += condition(query) ? 1 : 0;
    }
    return count > 0 ? static_cast<double>(fulfilled) / count : std::nan("");
  }

  void report() const {
    const double very = share(true, [](const Query& q) { return q.answer == q.model; });
    const double kind = share(true, [](const Query& q) { return q.same_class; });
    const double rejected = share(true, [](const Query& q) { return q.answer.empty(); });
    const double unknown = share(false, [](const Query& q) { return q.answer.empty(); });
    std::vector<double> times;
    for (const Query& query : queries_) times.push_back(query.milliseconds);
    std::sort(times.begin(), times.end());
    const double median = times[times.size() / 2], p95 = times[times.size() * 95 / 100];
    std::printf("%zu scans, %zu models\n", queries_.size(), (*database_)->size());
    std::printf("the very model first      %s %%\nits class first           %s %%\nfalsely unknown           %s %%\n",
                fixed(very, 1, 100).c_str(), fixed(kind, 1, 100).c_str(), fixed(rejected, 1, 100).c_str());
    std::printf("unknown, of those left out %s %%\nmilliseconds              %s (95 %%: %s)\n",
                fixed(unknown, 1, 100).c_str(), fixed(median, 0).c_str(), fixed(p95, 0).c_str());
    if (options_.csv) writeText(*options_.csv, csv());
    if (!options_.common.json_path) return;
    const nlohmann::json summary{{"scans", queries_.size()},
                                 {"models", (*database_)->size()},
                                 {"very_model_rate", very},
                                 {"class_rate", kind},
                                 {"false_unknown_rate", rejected},
                                 {"unknown_rate_of_left_out", unknown},
                                 {"median_ms", median},
                                 {"p95_ms", p95},
                                 {"seed", options_.common.seed},
                                 {"left_out", left_out_}};
    writeText(*options_.common.json_path, summary.dump(2) + "\n");
  }

  std::string csv() const {
    std::string text =
        Row().add("model").add("known").add("answer").add("same_class").add("merit").add("milliseconds").end();
    for (const Query& query : queries_)
      text += Row()
                  .add(query.model)
                  .add(query.known ? 1.0 : 0.0)
                  .add(query.answer)
                  .add(query.same_class ? 1.0 : 0.0)
                  .add(query.merit)
                  .add(query.milliseconds)
                  .end();
    return text;
  }

  const EvaluateRecognitionOptions& options_;
  ResumableRun& work_;
  const Console console_;
  std::optional<SharedDatabase> database_;
  std::vector<Model> models_;
  std::map<std::string, std::string> classes_;
  std::vector<Query> queries_;
  std::vector<std::string> left_out_;
};

}  // namespace

int evaluateRecognition(int argc, char** argv, SharedWork& processes) {
  EvaluateRecognitionOptions options;
  if (!commandLine(options).parse(argc, argv)) return 0;
  ResumableRun work(processes, options.journal, argc, argv);
  options.common.threads = work.threadsOfItem(options.common.threads);
  RecognitionEvaluation(options, work).run();
  return 0;
}

}  // namespace pcl_symmetry::apps
