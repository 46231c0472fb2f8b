#include "calibrate/merge_fitting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "evaluate/calibration/logistic_regression.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kNumRounds = 5;  // chosen: the round with the least distance counts; more rounds take longer
// Power of the product of the areas that a merge counts with. chosen: 1 is the share of a merge in the Rand index,
// which leaves first merges without weight; at 0.5 small regions outweigh the parts. measured: in-sample 0.137 at 0.5.
constexpr double kAreaPower = 0.75;
// chosen: weighted cases, see the regularisation path.
constexpr double kPullToZero = 1e-3;
constexpr double kFarthestShift = 3.0;   // log odds. chosen: beyond it, shapes are one part or one part a patch
constexpr double kShiftStep = 0.05;      // log odds. chosen: a small part of the intervals of the constant
constexpr std::size_t kRoundsOfFit = 2;  // chosen: one round alone makes the weights swing from round to round
constexpr double kQuantile = 1.96;       // derived: 97.5 % of a normal distribution lie below it

/// Small regions first, until areas are about a tenth of the surface: log odds without any knowledge.
MergeWeights firstRule() {
  MergeWeights weights{};
  weights[kAlways] = -4.0;
  weights[kContact] = 1.0;
  weights[kSmallArea] = weights[kLargeArea] = -1.0;
  return weights;
}

/// The shift of the constant with the least mean Rand distance, and that distance.
std::pair<double, double> bestShift(const std::vector<MergeRun>& runs) {
  std::pair<double, double> best{0.0, std::numeric_limits<double>::infinity()};
  const int num_steps = static_cast<int>(std::lround(kFarthestShift / kShiftStep));
  for (int step = -num_steps; step <= num_steps; ++step) {
    double sum = 0.0;
    for (const MergeRun& run : runs) sum += run.randAt(step * kShiftStep);
    const double mean = sum / static_cast<double>(runs.size());
    if (mean < best.second) best = {-step * kShiftStep, mean};
  }
  return best;
}

}  // namespace

MergeFitter::MergeFitter(const std::vector<PeopledModel>& models, std::vector<Cue> cues, int num_threads)
    : models_(models), cues_(std::move(cues)), num_threads_(num_threads) {}

MergeFitter::Round MergeFitter::run(const MergeWeights& weights) const {
  Round round(models_.size());
  parallelBlocks(models_.size(), num_threads_,
                 [&](std::size_t i) { round[i] = runMerges(*models_[i].division, weights); });
  return round;
}

LogisticCases MergeFitter::casesWithout(const std::string& category) const {
  std::vector<std::pair<const MergeSample*, int>> samples;
  for (const Round& round : rounds_)
    for (std::size_t i = 0; i < round.size(); ++i)
      for (const MergeSample& sample : round[i].samples)
        if (models_[i].category != category || category.empty()) samples.emplace_back(&sample, static_cast<int>(i));
  const auto num_rows = static_cast<Eigen::Index>(samples.size()), num_cues = static_cast<Eigen::Index>(cues_.size());
  LogisticCases cases{Eigen::MatrixXd(num_rows, num_cues), Eigen::VectorXd(num_rows), Eigen::VectorXd(num_rows), {}};
  for (Eigen::Index r = 0; r < num_rows; ++r) {
    const auto& [sample, model] = samples[static_cast<std::size_t>(r)];
    for (Eigen::Index k = 0; k < num_cues; ++k) cases.terms(r, k) = sample->cues[cues_[static_cast<std::size_t>(k)]];
    cases.outcomes[r] = sample->together;
    cases.weights[r] = std::pow(sample->weight, kAreaPower);
    cases.groups.push_back(model);
  }
  return cases;
}

MergeWeights MergeFitter::fitted(const LogisticCases& cases, double ridge, const MergeWeights& start) const {
  Eigen::VectorXd first(cases.terms.cols());
  for (Eigen::Index k = 0; k < first.size(); ++k) first[k] = start[cues_[static_cast<std::size_t>(k)]];
  const Eigen::VectorXd found = fitWeightedLogistic(cases, ridge, first);
  MergeWeights result{};
  for (Eigen::Index k = 0; k < found.size(); ++k) result[cues_[static_cast<std::size_t>(k)]] = found[k];
  return result;
}

MergeFitting MergeFitter::fit() {
  rounds_ = {run(firstRule())};
  MergeFitting result;
  result.fit.rand = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kNumRounds; ++round) {
    const LogisticCases cases = casesWithout("");
    MergeWeights weights = fitted(cases, kPullToZero, MergeWeights{});
    rounds_.push_back(run(weights));
    if (rounds_.size() > kRoundsOfFit) rounds_.erase(rounds_.begin());
    const auto [shift, rand] = bestShift(rounds_.back());
    if (rand >= result.fit.rand) continue;
    Eigen::VectorXd coefficients(cases.terms.cols());
    for (Eigen::Index k = 0; k < coefficients.size(); ++k)
      coefficients[k] = weights[cues_[static_cast<std::size_t>(k)]];
    const Eigen::VectorXd errors = groupedErrors(cases, coefficients);
    for (Eigen::Index k = 0; k < errors.size(); ++k)
      result.half_width[cues_[static_cast<std::size_t>(k)]] = kQuantile * errors[k];
    weights[kAlways] += shift;
    result.fit = {weights, rand};
    result.num_samples = cases.groups.size();
  }
  return result;
}

std::vector<PathPoint> MergeFitter::path(const std::vector<double>& ridges) const {
  std::set<std::string> categories;
  for (const PeopledModel& model : models_) categories.insert(model.category);
  std::vector<PathPoint> points;
  for (const double ridge : ridges) {
    const MergeWeights all = fitted(casesWithout(""), ridge, MergeWeights{});
    double sum = 0.0;
    for (const std::string& category : categories) {
      const MergeWeights weights = categories.size() > 1 ? fitted(casesWithout(category), ridge, all) : all;
      for (const PeopledModel& model : models_)
        if (model.category == category) sum += runMerges(*model.division, weights).randAt(0.0);
    }
    points.push_back({ridge, all, sum / static_cast<double>(models_.size())});
  }
  return points;
}

}  // namespace pcl_symmetry::apps
