#include "evaluate/scenes/recognition_curve.h"

#include <cstdio>
#include <map>
#include <tuple>

#include "evaluate/calibration/logistic_regression.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

// Steps of the least confidence, and of merits, whose range is the same. chosen: 2 %; half as many hide the bend of a
// curve of some hundred objects.
constexpr int kCurveSteps = 50;

/// Counts at one operating point.
struct OperatingCounts {
  Proportion right_model, right_pose, unknown_of_known, unknown_of_others;

  void add(const RecognitionResult& result, double least) {
    const bool accepted = !result.answer.empty() && result.confidence >= least;
    if (!result.is_known) {
      unknown_of_others.add(!accepted);
      return;
    }
    right_model.add(accepted && result.is_right);
    right_pose.add(accepted && result.right_pose);
    unknown_of_known.add(!accepted);
  }

  std::string endOf(Row& row) const {
    for (const Proportion* share : {&right_model, &right_pose, &unknown_of_known, &unknown_of_others})
      row.add(static_cast<double>(share->count)).add(static_cast<double>(share->total));
    return row.end();
  }
};

}  // namespace

std::string recognitionCurveCSV(const std::vector<SceneResult>& results) {
  std::string text = Row()
                         .add("noise")
                         .add("seen")
                         .add("occlusion_from")
                         .add("occlusion_to")
                         .add("min_confidence")
                         .add("right_model")
                         .add("known")
                         .add("right_model_and_pose")
                         .add("known")
                         .add("known_called_unknown")
                         .add("known")
                         .add("others_called_unknown")
                         .add("others")
                         .end();
  std::map<std::tuple<double, std::string, std::size_t, int>, OperatingCounts> points;
  for (const SceneResult& result : results) {
    const std::optional<std::size_t> band = bandOf(result.occlusion);
    if (!band || !result.recognition) continue;
    for (int i = 0; i <= kCurveSteps; ++i)
      points[{result.noise, result.row, *band, i}].add(*result.recognition, static_cast<double>(i) / kCurveSteps);
  }
  for (const auto& [key, counts] : points) {
    const auto& [noise, row, band, step] = key;
    Row line;
    line.add(noise).add(row).add(kOcclusionBands[band]).add(kOcclusionBands[band + 1]);
    text += counts.endOf(line.add(static_cast<double>(step) / kCurveSteps));
  }
  return text;
}

std::vector<Reliability> recognitionReliability(const std::vector<SceneResult>& results) {
  std::map<std::pair<double, std::string>, std::vector<Forecast>> groups;
  for (const SceneResult& result : results) {
    if (!bandOf(result.occlusion) || !result.recognition || result.recognition->answer.empty()) continue;
    groups[{result.noise, result.row}].push_back({result.recognition->confidence, result.recognition->is_right});
  }
  std::vector<Reliability> reliabilities;
  for (const auto& [key, forecasts] : groups)
    reliabilities.push_back(reliabilityOf("noise " + fixed(key.first, 1) + ", " + key.second, forecasts, {}));
  return reliabilities;
}

std::string fittedConfidence(const std::vector<SceneResult>& results) {
  std::vector<const RecognitionResult*> answers;
  for (const SceneResult& result : results)
    if (bandOf(result.occlusion) && result.recognition && !result.recognition->answer.empty())
      answers.push_back(&*result.recognition);
  const auto size = static_cast<Eigen::Index>(answers.size());
  if (size == 0) return "";
  Eigen::MatrixXd terms(size, 3);
  Eigen::VectorXd outcomes(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const RecognitionResult& answer = *answers[static_cast<std::size_t>(i)];
    terms.row(i) << 1.0, answer.merit, answer.lead;
    outcomes[i] = answer.is_right ? 1.0 : 0.0;
  }
  const Eigen::VectorXd fitted = fitLogistic(terms, outcomes);
  char line[128];
  std::snprintf(line, sizeof(line), "confidence of %zu answers: constant = %.1f, merit = %.1f, lead = %.1f\n",
                answers.size(), fitted[0], fitted[1], fitted[2]);
  return line;
}

}  // namespace pcl_symmetry::apps
