#include "evaluate/rotations/meshes/mesh_evaluation.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/command_line/console.h"
#include "common/shape_input/shape_input.h"
#include "common/shape_output/shape_output.h"
#include "core/detection/scan_axes/turn_confidence.h"
#include "evaluate/calibration/reliability.h"
#include "evaluate/rotations/meshes/mesh_rotations.h"
#include "evaluate/rotations/meshes/scan_turns.h"
#include "evaluate/shared/proportion.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

/// Groups that are hardly believed show whether low confidences come true. chosen: half finds no more.
constexpr double kHardlyBelieved = 0.02;

class MeshGroupEvaluation {
public:
  MeshGroupEvaluation(const EvaluateRotationsOptions& options, ResumableRun& work)
      : options_(options), work_(work), console_(options.common.quiet || !work.isFirst()) {}

  void run() {
    const std::vector<Model> models = listModels({*options_.meshes}, options_.selection);
    std::vector<std::string> names;
    for (const Model& model : models) names.push_back(model.name);
    meshes_.resize(models.size());
    Step step(console_, "Finding groups of " + std::to_string(models.size()) + " meshes");
    work_.run(names,
              {[&](std::size_t i) { return judge(models[i]); },
               [&](std::size_t i, const std::string& bytes) { meshes_[i] = unpackedGroups(bytes); },
               [](std::size_t) { return std::string(); }},
              options_.common.threads);
    if (!work_.isFirst()) return;
    step.done();
    report(names);
  }

private:
  /// Meshes that cannot be used have nothing to judge.
  std::string judge(const Model& model) const {
    try {
      const Shape shape = loadShape(model.path);
      if (!shape.mesh) throw InputError(model.path + ": has no faces");
      ObjectSymmetryOptions options = options_.symmetries;
      options.seed = options_.common.librarySeed();
      options.num_threads = 1;
      JudgedGroups groups;
      if (options_.counts.size() > 1)
        for (const double count : options_.counts)
          groups.names.push_back(groupOf(*shape.mesh, options, static_cast<int>(count)));
      options.min_confidence = kHardlyBelieved;
      groups.rotations = judgedRotations(*shape.mesh, options, static_cast<int>(options_.counts.front()));
      return packed(groups);
    } catch (const std::exception& error) {
      console_.warn(std::string("left out: ") + error.what());
      return "";
    }
  }

  void report(const std::vector<std::string>& names) const {
    std::vector<Forecast> groups, turns;
    Proportion same, same_of_symmetric;
    std::string text = Row().add("mesh").add("group").add("confidence").add("excess").end();
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (const JudgedRotation& rotation : meshes_[i].rotations) {
        (rotation.group == "rejected" ? turns : groups).push_back({rotation.confidence, rotation.isRight()});
        text += Row().add(names[i]).add(rotation.group).add(rotation.confidence).add(rotation.excess).end();
      }
      countSame(meshes_[i].names, names[i], same, same_of_symmetric);
    }
    const std::vector<Reliability> all = {reliabilityOf("groups", groups, {}),
                                          reliabilityOf("rejected turns", turns, {})};
    printReliability(all);
    if (same.total > 0) {
      std::printf("Same group for all numbers of points: %s; of meshes with a rotation at any: %s\n",
                  same.text().c_str(), same_of_symmetric.text().c_str());
    }
    if (options_.csv) writeText(*options_.csv, text);
    if (options_.common.json_path)
      writeText(*options_.common.json_path,
                nlohmann::json{
                    {"groups", toJson(all[0])},
                    {"rejected", toJson(all[1])},
                    {"same_group", {{"right", same.count}, {"all", same.total}}},
                    {"same_group_of_symmetric", {{"right", same_of_symmetric.count}, {"all", same_of_symmetric.total}}}}
                        .dump(2) +
                    "\n");
  }

  /// \param groups one name for each number of points.
  void countSame(const std::vector<std::string>& groups, const std::string& mesh, Proportion& same,
                 Proportion& same_of_symmetric) const {
    if (groups.empty()) return;
    const bool is_same = std::all_of(groups.begin(), groups.end(), [&](const auto& g) { return g == groups.front(); });
    same.add(is_same);
    if (!is_same || groups.front() != "C1") same_of_symmetric.add(is_same);
    if (is_same) return;
    std::printf("%-24s", mesh.c_str());
    for (const std::string& group : groups) std::printf(" %s", group.c_str());
    std::printf("\n");
  }

  const EvaluateRotationsOptions& options_;
  ResumableRun& work_;
  const Console console_;
  std::vector<JudgedGroups> meshes_;
};

// By TurnKind. derived: its names.
constexpr const char* kTurnKindNames[] = {"by any angle", "half turns", "of order 3 and more"};

void report(const std::vector<std::string>& names, const std::vector<std::vector<JudgedTurn>>& all,
            const EvaluateRotationsOptions& options) {
  std::vector<Forecast> forecasts[3], all_turns, believed;
  for (const std::vector<JudgedTurn>& some : all)
    for (const JudgedTurn& one : some) {
      const Forecast forecast{one.turn.confidence, one.isRight()};
      forecasts[static_cast<std::size_t>(kindOf(one.turn))].push_back(forecast);
      all_turns.push_back(forecast);
      if (one.turn.confidence >= kHardlyBelieved) believed.push_back(forecast);
    }
  std::vector<Reliability> groups{reliabilityOf("all turns of scans", all_turns, {}),
                                  reliabilityOf("0.02 and more", believed, {})};
  for (std::size_t kind = 0; kind < 3; ++kind)
    groups.push_back(reliabilityOf(kTurnKindNames[kind], forecasts[kind], {}));
  printReliability(groups);
  if (options.csv) writeText(*options.csv, turnTable(names, all));
  nlohmann::json summary;
  for (const Reliability& group : groups) summary[group.label] = toJson(group);
  if (options.common.json_path)
    writeText(*options.common.json_path, nlohmann::json{{"turns_of_scans", summary}}.dump(2) + "\n");
}

}  // namespace

void evaluateMeshGroups(const EvaluateRotationsOptions& options, ResumableRun& work) {
  MeshGroupEvaluation(options, work).run();
}

void evaluateScanTurns(const EvaluateRotationsOptions& options, ResumableRun& work) {
  const Console console(options.common.quiet || !work.isFirst());
  std::vector<Model> models;
  std::vector<std::string> names;
  if (options.meshes) {
    models = listModels({*options.meshes}, options.selection);
    for (const Model& model : models) names.push_back(model.name);
  } else {
    for (int i = 0; i < options.num_scans; ++i) names.push_back(solidName(i));
  }
  std::vector<std::vector<JudgedTurn>> all(names.size());
  Step step(console,
            "Judging the turns of scans of " + std::to_string(names.size()) + (options.meshes ? " meshes" : " solids"));
  const auto judge = [&](std::size_t i) -> std::string {
    try {
      return packed(options.meshes ? judgedTurns(models[i], options.num_scans)
                                   : judgedTurnsOfSolid(static_cast<int>(i), true));
    } catch (const std::exception& error) {
      console.warn("left out: " + names[i] + ": " + error.what());
      return "";
    }
  };
  work.run(names,
           {judge, [&](std::size_t i, const std::string& bytes) { all[i] = unpackedTurns(bytes); },
            [](std::size_t) { return std::string(); }},
           options.common.threads);
  if (!work.isFirst()) return;
  step.done();
  report(names, all, options);
}

}  // namespace pcl_symmetry::apps
