#include "evaluate/frames/alignment_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>

#include "common/pictures/chart.h"
#include "core/base/random.h"
#include "evaluate/planes/plane_statistics.h"
#include "evaluate/runs/packed_rows.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

// derived: all numbers of FrameErrors.
constexpr double FrameErrors::*kNumbers[] = {
    &FrameErrors::own_angle,   &FrameErrors::own_turned_angle, &FrameErrors::center,      &FrameErrors::axes_angle,
    &FrameErrors::frame_angle, &FrameErrors::equal_axes_angle, &FrameErrors::milliseconds};

constexpr double kReportedRightAngle = 5.0;  // degrees; chosen: as in alignment.cpp
// Bins of Figure 12. chosen: half is noisy for 100 models, twice hides the peak at zero. derived: 25 bins of 2.5
// degrees reach 62.5, the smallest angle over all orders and signs is below 63.
constexpr double kTranslationBin = 1.0;  // per cent of the diagonal
constexpr double kRotationBin = 2.5;     // degrees
constexpr int kTranslationBins = 20, kRotationBins = 25;

// Curves of Figure 12. chosen: bands of more than four cover each other.
constexpr AlignmentMethod kChartedMethods[] = {AlignmentMethod::Symmetry, AlignmentMethod::ExactMapRefined,
                                               AlignmentMethod::CenterOfMass, AlignmentMethod::PushedMass};
// Draws of the bootstrap. derived: the 25th from either side ends 95 %; as in pairedGain(), half of it.
constexpr std::size_t kNumResampled = 1000;

using Value = double FrameErrors::*;
using Errors = std::vector<const FrameErrors*>;

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(values.size());
}

std::vector<double> valuesOf(const Errors& errors, Value value) {
  std::vector<double> values;
  for (const FrameErrors* e : errors) values.push_back(e->*value);
  return values;
}

Proportion countRight(const Errors& errors, Value value) {
  Proportion right;
  for (const FrameErrors* e : errors) right.add(e->*value < kReportedRightAngle);
  return right;
}

double shareRight(const Errors& errors, Value value) {
  return countRight(errors, value).rate();
}

Errors select(const std::vector<FrameErrors>& errors, AlignmentMethod method, bool scans) {
  Errors selected;
  for (const FrameErrors& e : errors)
    if (e.method == method && (e.view >= 0) == scans) selected.push_back(&e);
  return selected;
}

std::map<std::string, double> meanCenters(const Errors& scans) {
  std::map<std::string, std::vector<double>> centers;
  for (const FrameErrors* e : scans) centers[e->model].push_back(e->center);
  std::map<std::string, double> means;
  for (const auto& [model, values] : centers) means[model] = mean(values);
  return means;
}

/// Of the ratio of the mean errors, models drawn anew with all their scans (Efron 1979).
Interval ratioInterval(const Errors& by_mass, const Errors& scans) {
  std::map<std::string, std::pair<double, double>> sums;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    sums[scans[i]->model].first += by_mass[i]->center;
    sums[scans[i]->model].second += scans[i]->center;
  }
  std::vector<std::pair<double, double>> models;
  for (const auto& [name, sum] : sums) models.push_back(sum);
  if (models.empty()) return {0.0, 0.0};
  RandomStream random(1);
  std::vector<double> ratios;
  for (std::size_t draw = 0; draw < kNumResampled; ++draw) {
    double mass = 0.0, own = 0.0;
    for (std::size_t i = 0; i < models.size(); ++i) {
      const auto& [of_mass, of_method] = models[random.below(models.size())];
      mass += of_mass;
      own += of_method;
    }
    ratios.push_back(mass / own);
  }
  std::sort(ratios.begin(), ratios.end());
  constexpr std::size_t kTail = kNumResampled / 40;  // derived: 2.5 % at either end
  return {ratios[kTail], ratios[kNumResampled - 1 - kTail]};
}

/// The counts behind the rates, where a model counts once or each scan does.
void addCounts(const Errors& by_mass, const Errors& scans, const Errors& wholes, AlignmentStatistics& s) {
  const auto mass_means = meanCenters(by_mass);
  for (std::size_t i = 0; i < scans.size(); ++i) s.counted_closer_scans.add(scans[i]->center < by_mass[i]->center);
  for (const auto& [model, center] : meanCenters(scans)) s.counted_closer_models.add(center < mass_means.at(model));
  s.counted_own_scans = countRight(scans, &FrameErrors::own_angle);
  s.counted_own_wholes = countRight(wholes, &FrameErrors::own_angle);
  s.counted_axes = countRight(scans, &FrameErrors::axes_angle);
  for (const FrameErrors* e : scans)
    if (e->tied_angle) s.counted_ties.add(*e->tied_angle < kReportedRightAngle);
  s.mean_ratio_interval = ratioInterval(by_mass, scans);
}

std::vector<Histogram> histograms(const std::vector<FrameErrors>& errors, Value value, double scale, double bin,
                                  int num_bins) {
  std::vector<Histogram> result;
  for (const AlignmentMethod method : kAlignmentMethods) {
    Histogram histogram{method, {}, std::vector<double>(num_bins + 1, 0.0), 0};
    for (int k = 0; k <= num_bins; ++k) histogram.lower_ends.push_back(k * bin);
    const Errors scans = select(errors, method, true);
    if (scans.empty()) continue;
    histogram.num_scans = static_cast<int>(scans.size());
    for (const FrameErrors* e : scans)
      histogram.shares[std::min(num_bins, static_cast<int>(scale * (e->*value) / bin))] +=
          1.0 / static_cast<double>(scans.size());
    result.push_back(std::move(histogram));
  }
  return result;
}

void draw(const std::vector<Histogram>& histograms, const std::string& title, const std::string& x,
          const std::string& path) {
  Chart chart;
  chart.title = title;
  chart.x.title = x;
  chart.y.title = "share of the scans";
  for (const Histogram& histogram : histograms) {
    if (std::find(std::begin(kChartedMethods), std::end(kChartedMethods), histogram.method) ==
        std::end(kChartedMethods))
      continue;
    ChartSeries series{toString(histogram.method), {}, histogram.shares};
    const double half = 0.5 * histogram.lower_ends[1];
    for (const double end : histogram.lower_ends) series.x.push_back(end + half);
    for (const double share : histogram.shares) {
      const int count = static_cast<int>(std::lround(share * histogram.num_scans));
      const Interval interval = Proportion{count, histogram.num_scans}.wilson();
      series.low.push_back(interval.low);
      series.high.push_back(interval.high);
    }
    chart.series.push_back(std::move(series));
  }
  writeChart(chart, path);
}

}  // namespace

void put(detail::PackedBytes& bytes, const FrameErrors& errors) {
  bytes.putText(errors.model);
  bytes.put(errors.view);
  bytes.put(errors.method);
  for (double FrameErrors::*number : kNumbers) bytes.put(errors.*number);
  putOptional(bytes, errors.tied_angle);
  bytes.put(errors.as_good);
}

void get(detail::UnpackedBytes& bytes, FrameErrors& errors) {
  errors.model = bytes.text();
  errors.view = bytes.get<int>();
  errors.method = bytes.get<AlignmentMethod>();
  for (double FrameErrors::*number : kNumbers) errors.*number = bytes.get<double>();
  getOptional(bytes, errors.tied_angle);
  errors.as_good = bytes.get<bool>();
}

std::vector<AlignmentStatistics> summarize(const std::vector<FrameErrors>& errors) {
  const Errors by_mass = select(errors, AlignmentMethod::CenterOfMass, true);
  std::vector<AlignmentStatistics> result;
  for (const AlignmentMethod method : kAlignmentMethods) {
    const Errors scans = select(errors, method, true), wholes = select(errors, method, false);
    if (wholes.empty()) continue;
    AlignmentStatistics s;
    s.method = method;
    s.num_models = static_cast<int>(wholes.size());
    s.num_scans = static_cast<int>(scans.size());
    addCounts(by_mass, scans, wholes, s);
    s.closer_scans = s.counted_closer_scans.rate();
    s.closer_models = s.counted_closer_models.rate();
    const std::vector<double> centers = valuesOf(scans, &FrameErrors::center);
    const std::vector<double> mass_centers = valuesOf(by_mass, &FrameErrors::center);
    s.mean_center = mean(centers);
    s.median_center = quantile(centers, 0.5);
    s.mean_ratio = mean(mass_centers) / s.mean_center;
    s.median_ratio = quantile(mass_centers, 0.5) / s.median_center;
    s.own_scans = shareRight(scans, &FrameErrors::own_angle);
    s.own_wholes = shareRight(wholes, &FrameErrors::own_angle);
    s.own_turned_scans = shareRight(scans, &FrameErrors::own_turned_angle);
    s.own_turned_wholes = shareRight(wholes, &FrameErrors::own_turned_angle);
    s.axes = shareRight(scans, &FrameErrors::axes_angle);
    s.frames = shareRight(scans, &FrameErrors::frame_angle);
    s.equal_axes = shareRight(scans, &FrameErrors::equal_axes_angle);
    std::vector<double> as_good;
    for (const FrameErrors* e : scans) as_good.push_back(e->as_good ? 1.0 : 0.0);
    s.as_good = mean(as_good);
    const std::vector<double> times = valuesOf(scans, &FrameErrors::milliseconds);
    s.median_ms = quantile(times, 0.5);
    s.p95_ms = quantile(times, 0.95);
    result.push_back(s);
  }
  return result;
}

void printTable(const std::vector<AlignmentStatistics>& statistics) {
  std::printf("%d models, %d scans\n", statistics.front().num_models, statistics.front().num_scans);
  std::printf("%-14s | %-13s %-15s %-13s | %-31s | %-33s | %s\n", "", "closer", "center", "mass / this",
              "model's own axes within 5 deg", "frame of the whole, 5 deg", "time");
  std::printf("%-14s | %6s %6s %7s %7s %6s %6s | %6s %6s %8s %8s | %6s %8s %9s %7s | %6s %6s\n", "", "models", "scans",
              "mean", "median", "mean", "median", "scans", "whole", "~ scans", "~ whole", "axes", "~ frames", "~ axes",
              "as good", "ms", "95 %");
  for (const AlignmentStatistics& s : statistics) {
    std::printf(
        "%-14s | %6s %6s %7s %7s %6s %6s | %6s %6s %8s %8s | %6s %8s %9s %7s | %6s %6s\n", toString(s.method).c_str(),
        fixed(s.closer_models, 1, 100).c_str(), fixed(s.closer_scans, 1, 100).c_str(),
        fixed(s.mean_center, 2, 100).c_str(), fixed(s.median_center, 2, 100).c_str(), fixed(s.mean_ratio, 2).c_str(),
        fixed(s.median_ratio, 2).c_str(), fixed(s.own_scans, 1, 100).c_str(), fixed(s.own_wholes, 1, 100).c_str(),
        fixed(s.own_turned_scans, 1, 100).c_str(), fixed(s.own_turned_wholes, 1, 100).c_str(),
        fixed(s.axes, 1, 100).c_str(), fixed(s.frames, 1, 100).c_str(), fixed(s.equal_axes, 1, 100).c_str(),
        fixed(s.as_good, 1, 100).c_str(), fixed(s.median_ms, 1).c_str(), fixed(s.p95_ms, 1).c_str());
  }
  std::printf(
      "closer: %% with a smaller error than by center of mass. center: error, %% of the diagonal. Axes are compared in "
      "any order and\nwith any sign. ~: own axes, at any angle about the whole's axis of revolution; frame of the "
      "whole, "
      "or one that it calls equally good.\nas good: that, or each plane scores on the whole as one of its own.\n");
}

void printIntervals(const std::vector<AlignmentStatistics>& statistics) {
  const bool ties = statistics.front().counted_ties.total > 0;
  std::printf("\n%-14s | %-31s | %-31s | %-22s | %-31s | %-31s%s\n", "", "closer, models", "closer, scans",
              "mass / this, mean", "own axes of scans", "own axes of wholes", ties ? " | like for like" : "");
  std::printf("%-14s | %-31s | %-31s | %-22s | %-31s | %-31s%s\n", "the paper", "", "90 %", "1.5", "70 %", "",
              ties ? " |" : "");
  for (const AlignmentStatistics& s : statistics) {
    const Interval& ratio = s.mean_ratio_interval;
    const std::string text = fixed(s.mean_ratio, 2) + " (" + fixed(ratio.low, 2) + " to " + fixed(ratio.high, 2) + ")";
    std::printf("%-14s | %-31s | %-31s | %-22s | %-31s | %-31s%s\n", toString(s.method).c_str(),
                s.counted_closer_models.text().c_str(), s.counted_closer_scans.text().c_str(), text.c_str(),
                s.counted_own_scans.text().c_str(), s.counted_own_wholes.text().c_str(),
                ties ? (" | " + s.counted_ties.text()).c_str() : "");
  }
  std::printf(
      "95 %% intervals.%s\n",
      ties ? " like for like: axes of scans within 5 deg of those of the whole, up to the symmetries of the mesh "
             "that brute force finds."
           : "");
}

nlohmann::json toJson(const std::vector<AlignmentStatistics>& statistics) {
  nlohmann::json list = nlohmann::json::array();
  for (const AlignmentStatistics& s : statistics) {
    list.push_back({{"method", toString(s.method)},
                    {"num_models", s.num_models},
                    {"num_scans", s.num_scans},
                    {"closer_rate", {{"models", s.closer_models}, {"scans", s.closer_scans}}},
                    {"center", {{"mean", s.mean_center}, {"median", s.median_center}}},
                    {"ratio_to_mass", {{"mean", s.mean_ratio}, {"median", s.median_ratio}}},
                    {"own_axes_rate", {{"scans", s.own_scans}, {"wholes", s.own_wholes}}},
                    {"own_axes_turned_rate", {{"scans", s.own_turned_scans}, {"wholes", s.own_turned_wholes}}},
                    {"axes_rate", s.axes},
                    {"like_for_like_rate", s.counted_ties.total > 0 ? nlohmann::json(s.counted_ties.rate()) : nullptr},
                    {"frame_rate", s.frames},
                    {"equal_axes_rate", s.equal_axes},
                    {"as_good_rate", s.as_good},
                    {"timing_ms", {{"median", s.median_ms}, {"p95", s.p95_ms}}}});
  }
  return list;
}

std::string frameCSV(const std::vector<FrameErrors>& errors) {
  std::string text =
      "model,view,method,own_angle_deg,own_turned_angle_deg,center,axes_angle_deg,frame_angle_deg,equal_axes_angle_deg,"
      "as_good,ms\n";
  for (const FrameErrors& e : errors) {
    const auto of_scan = [&](double value) { return e.view < 0 ? std::optional<double>() : value; };
    text += Row()
                .add(e.model)
                .add(e.view)
                .add(toString(e.method))
                .add(e.own_angle)
                .add(e.own_turned_angle)
                .add(of_scan(e.center))
                .add(of_scan(e.axes_angle))
                .add(of_scan(e.frame_angle))
                .add(of_scan(e.equal_axes_angle))
                .add(of_scan(e.as_good ? 1.0 : 0.0))
                .add(e.milliseconds)
                .end();
  }
  return text;
}

std::vector<Histogram> translationHistograms(const std::vector<FrameErrors>& errors) {
  return histograms(errors, &FrameErrors::center, 100.0, kTranslationBin, kTranslationBins);
}

std::vector<Histogram> rotationHistograms(const std::vector<FrameErrors>& errors) {
  return histograms(errors, &FrameErrors::axes_angle, 1.0, kRotationBin, kRotationBins);
}

std::string histogramCSV(const std::vector<FrameErrors>& errors) {
  std::string text = "misalignment,method,from,share\n";
  const auto add = [&](const char* kind, const std::vector<Histogram>& histograms) {
    for (const Histogram& histogram : histograms)
      for (std::size_t k = 0; k < histogram.shares.size(); ++k)
        text +=
            Row().add(kind).add(toString(histogram.method)).add(histogram.lower_ends[k]).add(histogram.shares[k]).end();
  };
  add("translation_percent", translationHistograms(errors));
  add("rotation_deg", rotationHistograms(errors));
  return text;
}

void drawHistograms(const std::vector<FrameErrors>& errors, const std::string& path) {
  draw(translationHistograms(errors), "Translational misalignment of scans",
       "distance of the centers, % of the diagonal", chartBeside(path, "_translation"));
  draw(rotationHistograms(errors), "Rotational misalignment of scans",
       "angle between the axes in any order and sign, degrees", chartBeside(path, "_rotation"));
}

}  // namespace pcl_symmetry::apps
