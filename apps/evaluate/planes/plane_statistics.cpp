#include "evaluate/planes/plane_statistics.h"
#include "core/base/constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_symmetry::apps {

namespace {

double ratio(double count, double total) {
  return total > 0.0 ? count / total : std::numeric_limits<double>::quiet_NaN();
}

double inDegrees(double radians) {
  return radians * 180.0 / kPi;
}

/// Counts the decision on one cloud.
void count(const CloudResult& result, DecisionStatistics& decisions) {
  if (result.kind == SymmetryKind::Symmetric) {
    decisions.decided_right.add(result.decidedRight());
    decisions.false_per_cloud += result.numFalse();
  } else {
    (result.kind == SymmetryKind::Asymmetric ? decisions.asymmetric_called : decisions.nearly_called)
        .add(result.called());
  }
  if (result.recipe.view < 0) return;
  const int num_contradicted = result.numFalse(ViewVerdict::Contradicted);
  decisions.num_contradicted += num_contradicted;
  decisions.num_undecidable += result.numFalse(ViewVerdict::Undecidable);
  if (result.kind == SymmetryKind::Asymmetric) decisions.asymmetric_contradicted.add(num_contradicted > 0);
}

}  // namespace

bool CloudResult::called() const {
  return std::any_of(answers.answers.begin(), answers.answers.end(),
                     [&](const Answer& answer) { return operating_point.calls(answer); });
}

bool CloudResult::decidedRight() const {
  for (std::size_t i = 0; i < match.judgements.size(); ++i)
    if (match.judgements[i].verdict != Verdict::Neutral && operating_point.calls(answers.answers[i]))
      return match.judgements[i].verdict == Verdict::Right;
  return false;
}

int CloudResult::numFalse(std::optional<ViewVerdict> verdict) const {
  int num_false = 0;
  for (std::size_t i = 0; i < match.judgements.size(); ++i) {
    const bool counts = match.judgements[i].verdict == Verdict::False && operating_point.calls(answers.answers[i]);
    num_false += counts && (!verdict || (i < view_verdicts.size() && view_verdicts[i] == *verdict)) ? 1 : 0;
  }
  return num_false;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (position - static_cast<double>(below)) * (values[above] - values[below]);
}

PlaneStatistics summarize(const CloudResults& results) {
  PlaneStatistics statistics;
  int num_first = 0, num_five = 0, num_no_answer = 0;
  int num_references = 0, num_found = 0, num_axes_found = 0;
  std::vector<double> angles, offsets, axis_angles, axis_offsets, times;
  for (const CloudResult* result : results) {
    const MatchResult& match = result->match;
    count(*result, statistics.decisions);
    statistics.num_failed += result->answers.failed ? 1 : 0;
    if (result->answers.milliseconds) times.push_back(*result->answers.milliseconds);
    if (result->kind == SymmetryKind::NearlySymmetric) {
      ++statistics.num_nearly;
    } else if (result->kind == SymmetryKind::Asymmetric) {
      ++statistics.num_asymmetric;
    } else {
      ++statistics.num_symmetric;
      num_first += result->firstIsRight() ? 1 : 0;
      num_five += match.rank && *match.rank <= 5 ? 1 : 0;
      num_no_answer += result->answers.answers.empty() ? 1 : 0;
      num_references += match.num_references;
      num_found += match.num_found;
      statistics.num_axes += result->num_reference_axes;
      num_axes_found += match.num_axes_found;
      if (match.first_error) {
        angles.push_back(inDegrees(match.first_error->angle));
        offsets.push_back(match.first_error->offset);
      }
      if (match.first_axis_error) {
        axis_angles.push_back(inDegrees(match.first_axis_error->angle));
        axis_offsets.push_back(match.first_axis_error->offset);
      }
    }
  }
  statistics.first_rate = ratio(num_first, statistics.num_symmetric);
  statistics.five_rate = ratio(num_five, statistics.num_symmetric);
  statistics.no_answer_rate = ratio(num_no_answer, statistics.num_symmetric);
  statistics.decisions.false_per_cloud = ratio(statistics.decisions.false_per_cloud, statistics.num_symmetric);
  statistics.recall = ratio(num_found, num_references);
  statistics.axis_rate = ratio(num_axes_found, statistics.num_axes);
  statistics.median_angle = quantile(angles, 0.5);
  statistics.p90_angle = quantile(angles, 0.9);
  statistics.median_offset = quantile(offsets, 0.5);
  statistics.p90_offset = quantile(offsets, 0.9);
  statistics.median_axis_angle = quantile(axis_angles, 0.5);
  statistics.median_axis_offset = quantile(axis_offsets, 0.5);
  statistics.median_ms = quantile(times, 0.5);
  statistics.p95_ms = quantile(times, 0.95);
  statistics.average_precision = averagePrecision(precisionRecall(results));
  return statistics;
}

std::vector<PrecisionRecall> precisionRecall(const CloudResults& results) {
  struct Scored {
    double score;
    bool right;
    int num_found;
  };
  std::vector<Scored> answers;
  int num_references = 0;
  for (const CloudResult* result : results) {
    if (result->kind == SymmetryKind::NearlySymmetric) continue;
    num_references += result->match.num_references;
    for (std::size_t i = 0; i < result->match.judgements.size(); ++i) {
      const Judgement& judgement = result->match.judgements[i];
      if (judgement.verdict == Verdict::Neutral) continue;
      answers.push_back({result->answers.answers[i].score, judgement.verdict == Verdict::Right, judgement.num_found});
    }
  }
  std::stable_sort(answers.begin(), answers.end(), [](const Scored& a, const Scored& b) { return a.score > b.score; });
  std::vector<PrecisionRecall> curve;
  if (num_references == 0) return curve;
  int num_right = 0, num_found = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    num_right += answers[i].right ? 1 : 0;
    num_found += answers[i].num_found;
    if (i + 1 < answers.size() && answers[i + 1].score == answers[i].score) continue;  // equal scores are one choice
    curve.push_back({answers[i].score, ratio(num_right, static_cast<double>(i + 1)), ratio(num_found, num_references)});
  }
  return curve;
}

double averagePrecision(const std::vector<PrecisionRecall>& curve) {
  double area = 0.0, best = 0.0;
  for (std::size_t i = curve.size(); i-- > 0;) {
    best = std::max(best, curve[i].precision);
    area += best * (curve[i].recall - (i > 0 ? curve[i - 1].recall : 0.0));
  }
  return area;
}

}  // namespace pcl_symmetry::apps
