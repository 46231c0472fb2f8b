#include "evaluate/scenes/scene_report.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "core/base/median.h"
#include "evaluate/planes/models/model_result.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

/// The objects of one row of the table.
struct Group {
  std::string name;
  double noise = 0.0;
  std::size_t band = 0;
  CloudResults planes;
  Proportion right_model, right_pose, unknown_of_known, unknown_of_others;
  std::vector<double> milliseconds;  ///< of recognitions
};

std::string nameOf(std::size_t band) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.0f to %.0f %%", 100.0 * kOcclusionBands[band],
                100.0 * kOcclusionBands[band + 1]);
  return text;
}

std::vector<Group> groupsOf(const std::vector<SceneResult>& results) {
  std::vector<Group> groups;
  for (const SceneResult& result : results) {
    const std::optional<std::size_t> band = bandOf(result.occlusion);
    if (!band) continue;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& other) {
      return other.name == result.row && other.noise == result.noise && other.band == *band;
    });
    if (group == groups.end())
      group = groups.insert(groups.end(), Group{result.row, result.noise, *band, {}, {}, {}, {}, {}, {}});
    if (result.asked_planes) group->planes.push_back(&result.planes);
    if (!result.recognition) continue;
    const RecognitionResult& recognition = *result.recognition;
    if (recognition.is_known) {
      group->right_model.add(recognition.accepted && recognition.is_right);
      group->right_pose.add(recognition.accepted && recognition.right_pose);
      group->unknown_of_known.add(!recognition.accepted);
    } else {
      group->unknown_of_others.add(!recognition.accepted);
    }
    group->milliseconds.push_back(recognition.milliseconds);
  }
  std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
    return a.noise != b.noise ? a.noise < b.noise : a.band < b.band;
  });
  return groups;
}

nlohmann::json toJson(const Proportion& proportion) {
  const Interval interval = proportion.wilson();
  return {{"count", proportion.count}, {"total", proportion.total}, {"low", interval.low}, {"high", interval.high}};
}

/// Objects of scenes are made without one.
const std::vector<CloudRecipe>& noRecipes() {
  static const std::vector<CloudRecipe> none(1);
  return none;
}

}  // namespace

void put(detail::PackedBytes& bytes, const RecognitionResult& result) {
  for (const bool is : {result.is_known, result.is_right, result.right_pose, result.accepted}) bytes.put(is);
  bytes.putText(result.answer);
  for (const double number :
       {result.support, result.conflict, result.merit, result.confidence, result.lead, result.milliseconds})
    bytes.put(number);
}

void get(detail::UnpackedBytes& bytes, RecognitionResult& result) {
  for (bool* is : {&result.is_known, &result.is_right, &result.right_pose, &result.accepted}) *is = bytes.get<bool>();
  result.answer = bytes.text();
  for (double* number :
       {&result.support, &result.conflict, &result.merit, &result.confidence, &result.lead, &result.milliseconds})
    *number = bytes.get<double>();
}

void put(detail::PackedBytes& bytes, const SceneResult& result) {
  bytes.put(result.scene);
  bytes.putText(result.row);
  for (const double number : {result.occlusion, result.noise}) bytes.put(number);
  bytes.put(result.asked_planes);
  put(bytes, result.planes, noRecipes());
  bytes.put(result.recognition.has_value());
  if (result.recognition) put(bytes, *result.recognition);
}

void get(detail::UnpackedBytes& bytes, SceneResult& result) {
  result.scene = bytes.get<int>();
  result.row = bytes.text();
  for (double* number : {&result.occlusion, &result.noise}) *number = bytes.get<double>();
  result.asked_planes = bytes.get<bool>();
  result.planes = cloudFrom(bytes, noRecipes());
  if (bytes.get<bool>()) get(bytes, result.recognition.emplace());
}

std::optional<std::size_t> bandOf(double occlusion) {
  for (std::size_t band = 0; band + 1 < std::size(kOcclusionBands); ++band)
    if (occlusion >= kOcclusionBands[band] && occlusion < kOcclusionBands[band + 1]) return band;
  return std::nullopt;
}

std::string sceneTable(const std::vector<SceneResult>& results) {
  std::string text;
  char line[256];
  std::snprintf(line, sizeof(line), "%-6s %-11s %-8s %-34s %-34s\n", "noise", "hidden", "seen",
                "symmetric: first plane right", "asymmetric: called symmetric");
  text += line;
  const std::vector<Group> groups = groupsOf(results);
  const bool has_planes =
      std::any_of(results.begin(), results.end(), [](const SceneResult& result) { return result.asked_planes; });
  if (!has_planes) text.clear();
  for (const Group& group : groups) {
    if (!has_planes) break;
    const DecisionStatistics decisions = summarize(group.planes).decisions;
    std::snprintf(line, sizeof(line), "%-6s %-11s %-8s %-34s %-34s\n", fixed(group.noise, 1).c_str(),
                  nameOf(group.band).c_str(), group.name.c_str(), decisions.decided_right.text().c_str(),
                  decisions.asymmetric_called.text().c_str());
    text += line;
  }
  const bool has_recognition = std::any_of(results.begin(), results.end(),
                                           [](const SceneResult& result) { return result.recognition.has_value(); });
  if (!has_recognition) return text;
  std::snprintf(line, sizeof(line), "\n%-6s %-11s %-8s %-31s %-31s %-31s %-31s %s\n", "noise", "hidden", "seen",
                "right model", "right model and pose", "known: called unknown", "others: called unknown", "ms");
  text += line;
  for (const Group& group : groups) {
    std::snprintf(line, sizeof(line), "%-6s %-11s %-8s %-31s %-31s %-31s %-31s %s\n", fixed(group.noise, 1).c_str(),
                  nameOf(group.band).c_str(), group.name.c_str(), group.right_model.text().c_str(),
                  group.right_pose.text().c_str(), group.unknown_of_known.text().c_str(),
                  group.unknown_of_others.text().c_str(), fixed(median(group.milliseconds), 0).c_str());
    text += line;
  }
  return text;
}

nlohmann::json sceneJson(const std::vector<SceneResult>& results) {
  nlohmann::json rows = nlohmann::json::array();
  for (const Group& group : groupsOf(results)) {
    const PlaneStatistics planes = summarize(group.planes);
    rows.push_back({{"noise", group.noise},
                    {"occlusion", {kOcclusionBands[group.band], kOcclusionBands[group.band + 1]}},
                    {"seen", group.name},
                    {"decided_right", toJson(planes.decisions.decided_right)},
                    {"asymmetric_called", toJson(planes.decisions.asymmetric_called)},
                    {"median_ms", planes.median_ms},
                    {"right_model", toJson(group.right_model)},
                    {"right_pose", toJson(group.right_pose)},
                    {"unknown_of_known", toJson(group.unknown_of_known)},
                    {"unknown_of_others", toJson(group.unknown_of_others)}});
  }
  return rows;
}

std::string sceneCSV(const std::vector<SceneResult>& results) {
  std::string text = Row()
                         .add("scene")
                         .add("model")
                         .add("kind")
                         .add("noise")
                         .add("occlusion")
                         .add("seen")
                         .add("points")
                         .add("called")
                         .add("decided_right")
                         .add("first_right")
                         .add("confidence")
                         .add("known")
                         .add("answer")
                         .add("accepted")
                         .add("right_pose")
                         .add("support")
                         .add("conflict")
                         .add("merit")
                         .add("lead")
                         .add("answer_confidence")
                         .add("milliseconds")
                         .end();
  for (const SceneResult& result : results) {
    const CloudResult& planes = result.planes;
    const bool has_answer = !planes.answers.answers.empty();
    Row row;
    row.add(static_cast<double>(result.scene)).add(planes.model).add(toString(planes.kind)).add(result.noise);
    row.add(result.occlusion).add(result.row).add(static_cast<double>(planes.num_points));
    row.add(planes.called() ? 1.0 : 0.0).add(planes.decidedRight() ? 1.0 : 0.0).add(planes.firstIsRight() ? 1.0 : 0.0);
    row.add(has_answer ? planes.answers.answers.front().score : 0.0);
    if (const auto& recognition = result.recognition)
      row.add(recognition->is_known ? 1.0 : 0.0)
          .add(recognition->answer)
          .add(recognition->accepted ? 1.0 : 0.0)
          .add(recognition->right_pose ? 1.0 : 0.0)
          .add(recognition->support)
          .add(recognition->conflict)
          .add(recognition->merit)
          .add(recognition->lead)
          .add(recognition->confidence)
          .add(recognition->milliseconds);
    text += row.end();
  }
  return text;
}

}  // namespace pcl_symmetry::apps
