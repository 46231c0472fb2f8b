#include "evaluate/planes/plane_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <sstream>

#include "common/pictures/chart.h"
#include "core/base/constants.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kBin = 10.0;  // degrees, of view angles; chosen: half leaves few scans in a bin, twice few bins

double degrees(double radians) {
  return radians * 180.0 / kPi;
}

std::optional<double> angleOf(const std::optional<Difference>& error) {
  return error ? std::optional<double>(degrees(error->angle)) : std::nullopt;
}

std::optional<double> offsetOf(const std::optional<Difference>& error) {
  return error ? std::optional<double>(100.0 * error->offset) : std::nullopt;
}

nlohmann::json toJson(const Proportion& proportion) {
  const Interval interval = proportion.wilson();
  return {{"count", proportion.count},
          {"total", proportion.total},
          {"rate", proportion.rate()},
          {"low", interval.low},
          {"high", interval.high}};
}

nlohmann::json toJson(const DecisionStatistics& d) {
  return {{"decided_right", toJson(d.decided_right)},
          {"asymmetric_called", toJson(d.asymmetric_called)},
          {"nearly_symmetric_called", toJson(d.nearly_called)},
          {"asymmetric_contradicted", toJson(d.asymmetric_contradicted)},
          {"false_per_cloud", d.false_per_cloud},
          {"num_false_contradicted", d.num_contradicted},
          {"num_false_undecidable", d.num_undecidable}};
}

std::string xTitle(Sweep sweep) {
  switch (sweep) {
    case Sweep::Noise:
      return "noise, standard deviation / diagonal";
    case Sweep::Points:
      return "number of points";
    case Sweep::Missing:
      return "share of the points that is missing";
    default:
      return "angle between view direction and normal of the plane, degrees";
  }
}

}  // namespace

std::vector<CloudGroup> groupResults(const std::vector<CloudResult>& results, Sweep sweep) {
  std::vector<CloudGroup> groups;
  for (const CloudResult& result : results) {
    std::string label = result.recipe.group;
    double x = result.recipe.x;
    if (sweep == Sweep::Views) {
      const double bin = result.view_angle ? std::min(std::floor(*result.view_angle / kBin), 90.0 / kBin - 1.0) : -1.0;
      label = bin < 0.0 ? "scan, no plane" : "scan, " + fixed(bin, 0, kBin) + "-" + fixed(bin + 1.0, 0, kBin) + " deg";
      x = bin < 0.0 ? std::numeric_limits<double>::quiet_NaN() : (bin + 0.5) * kBin;
    }
    auto group = std::find_if(groups.begin(), groups.end(), [&](const CloudGroup& g) { return g.label == label; });
    if (group == groups.end()) group = groups.insert(groups.end(), {label, x, {}, {}});
    group->results.push_back(&result);
  }
  if (sweep == Sweep::Views)
    std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  for (CloudGroup& group : groups) group.statistics = summarize(group.results);
  return groups;
}

void printDecisions(const std::vector<CloudGroup>& groups, const OperatingPoint& operating_point) {
  std::printf("Decisions: answers that are called symmetries, confidence >= %g; 95 %% Wilson intervals\n",
              operating_point.min_confidence);
  std::printf("%-22s | %-32s | %-32s | %-32s | %-32s | %6s %6s %6s\n", "", "decided and right,", "called symmetric,",
              "called symmetric,", "called against a visible point,", "false", "contra", "undec.");
  std::printf("%-22s | %-32s | %-32s | %-32s | %-32s | %6s %6s %6s\n", "clouds", "of symmetric", "of asymmetric",
              "of nearly symmetric", "of asymmetric", "/cloud", "", "");
  for (const CloudGroup& group : groups) {
    const DecisionStatistics& d = group.statistics.decisions;
    std::printf("%-22s | %-32s | %-32s | %-32s | %-32s | %6s %6d %6d\n", group.label.c_str(),
                d.decided_right.text().c_str(), d.asymmetric_called.text().c_str(), d.nearly_called.text().c_str(),
                d.asymmetric_contradicted.text().c_str(), fixed(d.false_per_cloud, 2).c_str(), d.num_contradicted,
                d.num_undecidable);
  }
}

void printRankings(const std::vector<CloudGroup>& groups) {
  std::printf("Rankings of all answers, whatever their confidence; errors of the first right one\n");
  std::printf("%-22s %5s %6s %6s %6s %6s | %6s %6s %6s %6s | %5s %6s | %5s %7s %7s\n", "", "sym.", "first", "in 5",
              "none", "recall", "angle", "90 %", "offset", "90 %", "axes", "found", "AP", "time", "95 %");
  std::printf("%-22s %5s %6s %6s %6s %6s | %6s %6s %6s %6s | %5s %6s | %5s %7s %7s\n", "clouds", "", "%", "%", "%", "%",
              "deg", "deg", "% diag", "% diag", "", "%", "", "ms", "ms");
  for (const CloudGroup& group : groups) {
    const PlaneStatistics& s = group.statistics;
    std::printf("%-22s %5d %6s %6s %6s %6s | %6s %6s %6s %6s | %5d %6s | %5s %7s %7s\n", group.label.c_str(),
                s.num_symmetric, fixed(s.first_rate, 1, 100).c_str(), fixed(s.five_rate, 1, 100).c_str(),
                fixed(s.no_answer_rate, 1, 100).c_str(), fixed(s.recall, 1, 100).c_str(),
                fixed(s.median_angle, 3).c_str(), fixed(s.p90_angle, 3).c_str(), fixed(s.median_offset, 3, 100).c_str(),
                fixed(s.p90_offset, 3, 100).c_str(), s.num_axes, fixed(s.axis_rate, 1, 100).c_str(),
                fixed(s.average_precision, 3).c_str(), fixed(s.median_ms, 1).c_str(), fixed(s.p95_ms, 1).c_str());
  }
}

std::vector<Reliability> reliabilities(const std::vector<CloudGroup>& groups) {
  std::vector<Reliability> all;
  for (const CloudGroup& group : groups) {
    std::vector<Forecast> forecasts;
    std::vector<ShareCase> cases;
    for (const CloudResult* result : group.results) {
      cases.push_back({result->best_share, result->called()});
      for (std::size_t i = 0; i < result->match.judgements.size(); ++i) {
        const Answer& answer = result->answers.answers[i];
        if (!answer.rank_only) forecasts.push_back({answer.score, result->match.judgements[i].at_reference});
      }
    }
    all.push_back(reliabilityOf(group.label, forecasts, cases));
  }
  return all;
}

nlohmann::json toJson(const std::vector<CloudGroup>& groups) {
  nlohmann::json list = nlohmann::json::array();
  const std::vector<Reliability> reliability = reliabilities(groups);
  for (const CloudGroup& group : groups) {
    const PlaneStatistics& s = group.statistics;
    list.push_back({{"group", group.label},
                    {"x", group.x},
                    {"num_symmetric", s.num_symmetric},
                    {"num_asymmetric", s.num_asymmetric},
                    {"num_nearly_symmetric", s.num_nearly},
                    {"num_failed", s.num_failed},
                    {"first_rate", s.first_rate},
                    {"five_rate", s.five_rate},
                    {"no_answer_rate", s.no_answer_rate},
                    {"recall", s.recall},
                    {"decisions", toJson(s.decisions)},
                    {"angle_deg", {{"median", s.median_angle}, {"p90", s.p90_angle}}},
                    {"offset", {{"median", s.median_offset}, {"p90", s.p90_offset}}},
                    {"num_axes", s.num_axes},
                    {"axis_rate", s.axis_rate},
                    {"axis_angle_deg", {{"median", s.median_axis_angle}}},
                    {"axis_offset", {{"median", s.median_axis_offset}}},
                    {"average_precision", s.average_precision},
                    {"reliability", toJson(reliability[list.size()])},
                    {"timing_ms", {{"median", s.median_ms}, {"p95", s.p95_ms}}}});
  }
  return list;
}

std::string cloudCSV(const std::vector<CloudResult>& results) {
  std::string text =
      "model,kind,best_share,cloud,group,points,noise,missing,view_angle_deg,references,reference_axes,failed,answers,"
      "called,decided_right,first_right,rank,angle_deg,offset_percent,right,neutral,false,found,axes_found,axis_angle_"
      "deg,"
      "axis_offset_percent,best_score,false_called,false_contradicted,false_undecidable,ms\n";
  for (const CloudResult& r : results) {
    const MatchResult& m = r.match;
    std::optional<double> best_score;
    for (const Answer& answer : r.answers.answers)
      best_score = std::max(best_score.value_or(answer.score), answer.score);
    text += Row()
                .add(r.model)
                .add(toString(r.kind))
                .add(r.best_share)
                .add(r.cloud)
                .add(r.recipe.group)
                .add(static_cast<double>(r.num_points))
                .add(r.recipe.noise)
                .add(r.recipe.missing)
                .add(r.view_angle)
                .add(m.num_references)
                .add(r.num_reference_axes)
                .add(r.answers.failed ? 1 : 0)
                .add(static_cast<double>(r.answers.answers.size()))
                .add(r.called() ? 1 : 0)
                .add(r.decidedRight() ? 1 : 0)
                .add(r.firstIsRight() ? 1 : 0)
                .add(m.rank ? std::optional<double>(*m.rank) : std::nullopt)
                .add(angleOf(m.first_error))
                .add(offsetOf(m.first_error))
                .add(m.num_right)
                .add(m.num_neutral)
                .add(m.num_false)
                .add(m.num_found)
                .add(m.num_axes_found)
                .add(angleOf(m.first_axis_error))
                .add(offsetOf(m.first_axis_error))
                .add(best_score)
                .add(r.numFalse())
                .add(r.numFalse(ViewVerdict::Contradicted))
                .add(r.numFalse(ViewVerdict::Undecidable))
                .add(r.answers.milliseconds)
                .end();
  }
  return text;
}

std::string modelCSV(const std::vector<CloudResult>& results) {
  std::vector<CloudGroup> models;
  for (const CloudResult& result : results) {
    if (models.empty() || models.back().label != result.model) models.push_back({result.model, 0.0, {}, {}});
    models.back().results.push_back(&result);
  }
  std::string text =
      "model,kind,best_share,references,reference_axes,clouds,first_rate,five_rate,no_answer_rate,recall,"
      "called_rate,decided_right_rate,answers_per_cloud,false_per_cloud,median_angle_deg,median_offset_percent,median_"
      "ms\n";
  for (const CloudGroup& model : models) {
    const CloudResult& first = *model.results.front();
    const PlaneStatistics s = summarize(model.results);
    double num_answers = 0.0, num_false = 0.0, num_called = 0.0;
    for (const CloudResult* result : model.results) {
      num_answers += static_cast<double>(result->answers.answers.size());
      num_false += result->match.num_false;
      num_called += result->called() ? 1.0 : 0.0;
    }
    const double num_clouds = static_cast<double>(model.results.size());
    text += Row()
                .add(model.label)
                .add(toString(first.kind))
                .add(first.best_share)
                .add(first.match.num_references)
                .add(first.num_reference_axes)
                .add(num_clouds)
                .add(s.first_rate)
                .add(s.five_rate)
                .add(s.no_answer_rate)
                .add(s.recall)
                .add(num_called / num_clouds)
                .add(s.decisions.decided_right.rate())
                .add(num_answers / num_clouds)
                .add(num_false / num_clouds)
                .add(s.median_angle)
                .add(100.0 * s.median_offset)
                .add(s.median_ms)
                .end();
  }
  return text;
}

std::string precisionRecallCSV(const std::vector<CloudGroup>& groups) {
  std::string text = "group,score,precision,recall\n";
  for (const CloudGroup& group : groups)
    for (const PrecisionRecall& at : precisionRecall(group.results))
      text += Row().add(group.label).add(at.score).add(at.precision).add(at.recall).end();
  return text;
}

void drawChart(const std::vector<CloudGroup>& groups, Sweep sweep, const std::string& path) {
  Chart chart;
  chart.y.range = {0.0, 1.02};  // keeps lines at 1 off the frame
  chart.legend_at_bottom_left = true;
  if (sweep == Sweep::None) {
    chart.title = "Precision and recall of symmetry planes";
    chart.x = {"recall", false, std::make_pair(0.0, 1.02)};
    chart.y.title = "precision";
    for (const CloudGroup& group : groups) {
      ChartSeries series{group.label + ", AP " + fixed(group.statistics.average_precision, 2), {}, {}};
      series.points = false;
      for (const PrecisionRecall& at : precisionRecall(group.results)) {
        series.x.push_back(at.recall);
        series.y.push_back(at.precision);
      }
      chart.series.push_back(series);
    }
  } else {
    chart.title = "Symmetry planes: rates";
    chart.x = {xTitle(sweep), sweep == Sweep::Points, {}};
    chart.y.title = "rate";
    const std::pair<const char*, double (*)(const PlaneStatistics&)> rates[] = {
        {"decided and right", [](const PlaneStatistics& s) { return s.decisions.decided_right.rate(); }},
        {"first answer is right", [](const PlaneStatistics& s) { return s.first_rate; }},
        {"references found", [](const PlaneStatistics& s) { return s.recall; }},
        {"asymmetric, called symmetric",
         [](const PlaneStatistics& s) { return s.decisions.asymmetric_called.rate(); }}};
    for (const auto& [name, rate] : rates) {
      ChartSeries series{name, {}, {}};
      for (const CloudGroup& group : groups) {
        series.x.push_back(group.x);
        series.y.push_back(rate(group.statistics));
      }
      chart.series.push_back(series);
    }
  }
  const bool has_values = std::any_of(chart.series.begin(), chart.series.end(), [](const ChartSeries& series) {
    return std::any_of(series.y.begin(), series.y.end(), [](double y) { return std::isfinite(y); });
  });
  if (!has_values) chart.series.push_back({"nothing found", {0.0}, {0.0}});
  writeChart(chart, path);
}

}  // namespace pcl_symmetry::apps
