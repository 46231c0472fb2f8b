#include "evaluate/calibration/reliability.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

#include "core/base/random.h"
#include "evaluate/shared/table_text.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kNumBins = 10;  // chosen: with some hundred answers twice leaves bins of a handful, half hides curves
// Draws of the calibration error by chance. chosen: its mean is then known to 2 %; twice takes twice the time.
constexpr int kNumDraws = 200;
/// Borders of the bins of the best share. chosen: fine where the answer should change, between near and symmetric.
constexpr double kShares[] = {0.0, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.92, 0.94, 0.95, 0.96, 0.97, 0.98, 0.99, 1.0};

nlohmann::json withInterval(nlohmann::json bin, const Proportion& proportion, const char* name) {
  const Interval interval = proportion.wilson();
  bin["count"] = proportion.total;
  bin[name] = {{"rate", proportion.rate()}, {"low", interval.low}, {"high", interval.high}};
  return bin;
}

void printHeading(const char* first, const std::vector<std::string>& borders) {
  std::printf("%-22s", first);
  for (const std::string& border : borders) std::printf(" %10s", border.c_str());
  std::printf("\n");
}

/// Per cent and number of cases, e.g. "97 / 217".
std::string cell(const Proportion& proportion) {
  return proportion.total > 0 ? fixed(proportion.rate(), 0, 100) + " / " + std::to_string(proportion.total) : "-";
}

std::size_t binOf(double confidence) {
  return static_cast<std::size_t>(std::min(kNumBins - 1, static_cast<int>(confidence * kNumBins)));
}

/// Mean over draws of the calibration error that forecasts have which are right as often as they say.
double chanceError(const std::vector<Forecast>& forecasts) {
  RandomStream random(1);
  double sum = 0.0;
  for (int draw = 0; draw < kNumDraws; ++draw) {
    std::array<double, kNumBins> beyond{};  // stated less drawn
    for (const Forecast& forecast : forecasts) {
      const double confidence = std::clamp(forecast.confidence, 0.0, 1.0);
      beyond[binOf(confidence)] += confidence - (random.uniform() < confidence ? 1.0 : 0.0);
    }
    for (const double error : beyond) sum += std::abs(error);
  }
  return sum / kNumDraws / static_cast<double>(forecasts.size());
}

void countForecasts(const std::vector<Forecast>& forecasts, Reliability& reliability) {
  for (int k = 0; k < kNumBins; ++k)
    reliability.bins.push_back({static_cast<double>(k) / kNumBins, static_cast<double>(k + 1) / kNumBins, 0.0, {}});
  reliability.num_forecasts = static_cast<int>(forecasts.size());
  double sum_squares = 0.0, sum_errors = 0.0;
  for (const Forecast& forecast : forecasts) {
    const double confidence = std::clamp(forecast.confidence, 0.0, 1.0);
    ReliabilityBin& bin = reliability.bins[binOf(confidence)];
    bin.sum_confidence += confidence;
    bin.right.add(forecast.right);
    sum_squares += std::pow(confidence - (forecast.right ? 1.0 : 0.0), 2);
  }
  for (const ReliabilityBin& bin : reliability.bins) sum_errors += std::abs(bin.sum_confidence - bin.right.count);
  const double size =
      forecasts.empty() ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(forecasts.size());
  reliability.brier = sum_squares / size;
  reliability.calibration_error = sum_errors / size;
  reliability.chance_error = chanceError(forecasts);
}

}  // namespace

Reliability reliabilityOf(const std::string& label, const std::vector<Forecast>& forecasts,
                          const std::vector<ShareCase>& cases) {
  Reliability reliability;
  reliability.label = label;
  countForecasts(forecasts, reliability);
  for (std::size_t k = 0; k + 1 < std::size(kShares); ++k)
    reliability.shares.push_back({kShares[k], kShares[k + 1], {}});
  for (const ShareCase& one : cases) {
    const auto above = std::upper_bound(std::begin(kShares), std::end(kShares) - 1, one.best_share);
    const auto index = std::max<std::ptrdiff_t>(0, above - std::begin(kShares) - 1);
    reliability.shares[std::min<std::size_t>(static_cast<std::size_t>(index), reliability.shares.size() - 1)]
        .called.add(one.called);
  }
  return reliability;
}

void printReliability(const std::vector<Reliability>& groups) {
  if (groups.empty()) return;
  std::vector<std::string> borders = {"answers", "ECE", "by chance", "Brier"};
  for (const ReliabilityBin& bin : groups.front().bins) borders.push_back(fixed(bin.low, 1) + "-" + fixed(bin.high, 1));
  std::printf("Reliability: answers at a reference, %% / answers, by confidence\n");
  printHeading("clouds", borders);
  for (const Reliability& group : groups) {
    std::printf("%-22s %10d %10s %10s %10s", group.label.c_str(), group.num_forecasts,
                fixed(group.calibration_error, 3).c_str(), fixed(group.chance_error, 3).c_str(),
                fixed(group.brier, 3).c_str());
    for (const ReliabilityBin& bin : group.bins) std::printf(" %10s", cell(bin.right).c_str());
    std::printf("\n");
  }
  const auto has_cases = [](const Reliability& group) {
    return std::any_of(group.shares.begin(), group.shares.end(),
                       [](const ShareBin& bin) { return bin.called.total > 0; });
  };
  if (std::none_of(groups.begin(), groups.end(), has_cases)) return;
  borders.clear();
  for (const ShareBin& bin : groups.front().shares)
    borders.push_back(fixed(bin.low, 0, 100) + "-" + fixed(bin.high, 0, 100));
  std::printf(
      "Clouds called symmetric, %% / clouds, by the share of the surface that the best plane of the model maps, %%\n");
  printHeading("clouds", borders);
  for (const Reliability& group : groups) {
    std::printf("%-22s", group.label.c_str());
    for (const ShareBin& bin : group.shares) std::printf(" %10s", cell(bin.called).c_str());
    std::printf("\n");
  }
}

nlohmann::json toJson(const Reliability& reliability) {
  nlohmann::json bins = nlohmann::json::array(), shares = nlohmann::json::array();
  for (const ReliabilityBin& bin : reliability.bins)
    bins.push_back(withInterval({{"low", bin.low}, {"high", bin.high}, {"mean_confidence", bin.meanConfidence()}},
                                bin.right, "right"));
  for (const ShareBin& bin : reliability.shares)
    shares.push_back(withInterval({{"low", bin.low}, {"high", bin.high}}, bin.called, "called"));
  return {{"num_answers", reliability.num_forecasts},
          {"expected_calibration_error", reliability.calibration_error},
          {"brier", reliability.brier},
          {"bins", bins},
          {"called_by_share", shares}};
}

std::string reliabilityCSV(const std::vector<Reliability>& groups) {
  std::string text = "group,low,high,answers,mean_confidence,right_rate,right_low,right_high\n";
  for (const Reliability& group : groups) {
    for (const ReliabilityBin& bin : group.bins) {
      const Interval interval = bin.right.wilson();
      text += Row()
                  .add(group.label)
                  .add(bin.low)
                  .add(bin.high)
                  .add(bin.right.total)
                  .add(bin.meanConfidence())
                  .add(bin.right.rate())
                  .add(interval.low)
                  .add(interval.high)
                  .end();
    }
  }
  return text;
}

std::string shareCSV(const std::vector<Reliability>& groups) {
  std::string text = "group,low,high,clouds,called_rate,called_low,called_high\n";
  for (const Reliability& group : groups) {
    for (const ShareBin& bin : group.shares) {
      const Interval interval = bin.called.wilson();
      text += Row()
                  .add(group.label)
                  .add(bin.low)
                  .add(bin.high)
                  .add(bin.called.total)
                  .add(bin.called.rate())
                  .add(interval.low)
                  .add(interval.high)
                  .end();
    }
  }
  return text;
}

}  // namespace pcl_symmetry::apps
