#include "evaluate/rotations/rotations.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/command_line/tool_errors.h"
#include "common/shape_output/shape_output.h"
#include "core/base/median.h"
#include "core/base/stopwatch.h"
#include "evaluate/rotations/meshes/mesh_evaluation.h"
#include "evaluate/rotations/rotation_options.h"
#include "evaluate/rotations/rotation_solids.h"
#include "evaluate/runs/resumable_run.h"
#include "evaluate/shared/model_flags.h"
#include "evaluate/shared/table_text.h"
#include "pcl_symmetry/core/rotation/rotational_symmetry.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

namespace {

CommandLine commandLine(EvaluateRotationsOptions& o) {
  CommandLine line(
      "pcl_symmetry_evaluate rotations",
      "Finds the groups of rotations of solids of known groups, in random poses: those of the kinds that "
      "the constants of the library were chosen on, and others. With -meshes, finds those of meshes, and "
      "measures by exact distances how often groups and rejected turns of a confidence are symmetries, and how "
      "often the groups are the same for all numbers of points. With -scans, measures the same of the turns "
      "that are found in single scans.",
      "pcl_symmetry_evaluate rotations -seeds 5 -csv groups.csv");
  line.numbers("counts", o.counts, Range::closed(100, 10'000'000), "numbers of points")
      .numbers("noise", o.noise, Range::closed(0, 0.1), "standard deviations of the coordinates, share of the diameter")
      .number("seeds", o.num_seeds, Range::closed(1, 1000), "number of samplings and poses of each")
      .number("tolerance", o.symmetries.tolerance, Range::upTo(0, 0.1),
              "how far a symmetric surface may be off, share of the diameter")
      .number("feature", o.symmetries.max_feature, Range::closed(0, 1), "share of the surface that may be off by more")
      .text("kind", "NAME", o.kind, "solids of this kind alone")
      .text("meshes", "DIR", o.meshes,
            "meshes in place of solids; confidences are measured on clouds of the first of -counts")
      .number("scans", o.num_scans, Range::closed(0, 100'000),
              "judge the turns of this number of scans: of each mesh, or of solids of `shapes turns` together")
      .text("csv", "FILE", o.csv,
            "a row for each cloud; with -meshes for each group and rejected turn, with -scans for each turn");
  addSelectionFlags(line, o.selection);
  ResumableRun::addFlag(line, o.journal);
  line.common(o.common, kJson | kSeed | kThreads | kQuiet);
  return line;
}

/// A cloud and what was found.
struct Trial {
  const RotationSolid* solid;
  int num_points;
  double noise;
  std::uint64_t seed;
  std::string found = {};
  double confidence = 0.0, ms = 0.0;

  bool isRight() const { return found == solid->group; }
  std::string name() const {
    return solid->name + " " + std::to_string(num_points) + " " + std::to_string(noise) + " " + std::to_string(seed);
  }
};

/// What is found of a trial, on its way from one process to another.
std::string packedAnswer(const std::string& group, double confidence, double ms) {
  detail::PackedBytes bytes;
  bytes.put(confidence);
  bytes.put(ms);
  bytes.append(group);
  return bytes.bytes();
}

/// Right answers of all.
struct Count {
  int right = 0, all = 0;

  void add(bool is_right) {
    right += is_right ? 1 : 0;
    ++all;
  }
  nlohmann::json toJson() const { return {{"right", right}, {"all", all}}; }
};

class RotationEvaluation {
public:
  RotationEvaluation(const EvaluateRotationsOptions& options, ResumableRun& work)
      : options_(options), work_(work), console_(options.common.quiet || !work.isFirst()), solids_(rotationSolids()) {}

  void run() {
    makeTrials();
    if (trials_.empty()) throw UsageError("-kind " + options_.kind.value_or("") + ": there is no such kind");
    Step step(console_, "Finding groups of " + std::to_string(trials_.size()) + " clouds");
    std::vector<std::string> names;
    for (const Trial& trial : trials_) names.push_back(trial.name());
    work_.run(names,
              {[this](std::size_t i) { return find(trials_[i]); },
               [this](std::size_t i, const std::string& answer) { take(trials_[i], answer); },
               [](std::size_t) { return packedAnswer("none, processes died", 0.0, 0.0); }},
              options_.common.threads);
    if (!work_.isFirst()) return;
    step.done();
    report();
  }

private:
  void makeTrials() {
    for (const RotationSolid& solid : solids_) {
      if (options_.kind && solid.kind != *options_.kind) continue;
      for (const double count : options_.counts)
        for (const double noise : options_.noise)
          for (int k = 0; k < options_.num_seeds; ++k)
            trials_.push_back(
                {&solid, static_cast<int>(count), noise, options_.common.seed + 1 + static_cast<std::uint64_t>(k)});
    }
  }

  std::string find(const Trial& trial) const {
    const auto count = static_cast<std::uint64_t>(trial.num_points);
    const Points points = trial.solid->sampled(trial.num_points, trial.seed * 1'000'003 + count, trial.noise);
    ObjectSymmetryOptions options = options_.symmetries;
    options.seed = trial.seed;
    options.num_threads = 1;
    Stopwatch watch;
    const ObjectSymmetries found = objectSymmetries(points, options);
    return packedAnswer(found.name(), found.confidence, watch.lap());
  }

  static void take(Trial& trial, const std::string& answer) {
    detail::UnpackedBytes bytes(answer);
    trial.confidence = bytes.get<double>();
    trial.ms = bytes.get<double>();
    const std::size_t size = bytes.left();
    trial.found.assign(bytes.take(size), size);
  }

  /// Sets of clouds of one solid, noise and seed whose groups are the same for all numbers of points.
  Count sameGroups() const {
    std::map<std::tuple<std::string, double, std::uint64_t>, std::set<std::string>> groups;
    for (const Trial& trial : trials_) groups[{trial.solid->name, trial.noise, trial.seed}].insert(trial.found);
    Count count;
    for (const auto& [key, names] : groups) count.add(names.size() == 1);
    return count;
  }

  Count countOf(const std::function<bool(const Trial&)>& which) const {
    Count count;
    for (const Trial& trial : trials_)
      if (which(trial)) count.add(trial.isRight());
    return count;
  }

  void report() const {
    printSolids();
    const Count chosen = countOf([](const Trial& t) { return t.solid->chosen_on; });
    const Count others = countOf([](const Trial& t) { return !t.solid->chosen_on; });
    const Count same = sameGroups();
    const auto spheres =
        std::count_if(trials_.begin(), trials_.end(), [](const Trial& t) { return t.found == "SO3" && !t.isRight(); });
    std::printf("\n%-44s %6d of %d\n", "right, kinds that constants were chosen on", chosen.right, chosen.all);
    std::printf("%-44s %6d of %d\n", "right, other kinds", others.right, others.all);
    std::printf("%-44s %6d\n", "spheres that are none", static_cast<int>(spheres));
    std::printf("%-44s %6d of %d\n", "same group for all numbers of points", same.right, same.all);
    nlohmann::json by_count = nlohmann::json::object();
    for (const double count : options_.counts) {
      const auto num_points = static_cast<int>(count);
      std::vector<double> times;
      for (const Trial& trial : trials_)
        if (trial.num_points == num_points) times.push_back(trial.ms);
      const Count right = countOf([&](const Trial& t) { return t.num_points == num_points; });
      std::printf("%6d points %-31s %6d of %d, median %.0f ms on one thread\n", num_points, "", right.right, right.all,
                  median(times));
      by_count[std::to_string(num_points)] = right.toJson();
      by_count[std::to_string(num_points)]["median_ms"] = median(times);
    }
    if (options_.csv) writeText(*options_.csv, table());
    if (options_.common.json_path)
      writeText(*options_.common.json_path, nlohmann::json{{"chosen_on", chosen.toJson()},
                                                           {"others", others.toJson()},
                                                           {"false_spheres", spheres},
                                                           {"same_group", same.toJson()},
                                                           {"points", by_count}}
                                                    .dump(2) +
                                                "\n");
  }

  void printSolids() const {
    std::printf("%-32s %-6s %9s  wrong answers\n", "solid", "group", "right");
    for (const RotationSolid& solid : solids_) {
      const Count right = countOf([&](const Trial& t) { return t.solid == &solid; });
      if (right.all == 0) continue;
      std::string wrong;
      for (const Trial& t : trials_)
        if (t.solid == &solid && !t.isRight())
          wrong += "  " + t.found + " (" + std::to_string(t.num_points) + (t.noise > 0.0 ? ", noise)" : ")");
      std::printf("%-32s %-6s %3d of %2d%s\n", solid.name.c_str(), solid.group.c_str(), right.right, right.all,
                  wrong.c_str());
    }
  }

  std::string table() const {
    Row head;
    for (const char* title :
         {"solid", "kind", "chosen_on", "points", "noise", "seed", "group", "found", "confidence", "ms"})
      head.add(title);
    std::string text = head.end();
    for (const Trial& t : trials_)
      text += Row()
                  .add(t.solid->name)
                  .add(t.solid->kind)
                  .add(t.solid->chosen_on ? 1.0 : 0.0)
                  .add(static_cast<double>(t.num_points))
                  .add(t.noise)
                  .add(static_cast<double>(t.seed))
                  .add(t.solid->group)
                  .add(t.found)
                  .add(t.confidence)
                  .add(t.ms)
                  .end();
    return text;
  }

  const EvaluateRotationsOptions& options_;
  ResumableRun& work_;
  const Console console_;
  const std::vector<RotationSolid> solids_;
  std::vector<Trial> trials_;
};

}  // namespace

int evaluateRotations(int argc, char** argv, SharedWork& processes) {
  EvaluateRotationsOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  ResumableRun work(processes, options.journal, argc, argv);
  if (options.num_scans > 0)
    evaluateScanTurns(options, work);
  else if (options.meshes)
    evaluateMeshGroups(options, work);
  else
    RotationEvaluation(options, work).run();
  return 0;
}

}  // namespace pcl_symmetry::apps
