#include "calibrate/planes/confidence_fitting.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include "common/command_line/run_tool.h"
#include "evaluate/calibration/logistic_regression.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kLowShare = 0.025, kHighShare = 0.975;  // derived: 95 % of the errors lie between these shares of them
// chosen: from the third pass on, two fits alternate whose numbers differ by 5 % at most and which decide alike.
constexpr int kFurtherPasses = 10;

// Weight of nearly symmetric planes of scans and of clouds that were cut, which seldom show what tells them from
// symmetries; elsewhere they are none like others. chosen: by cross-validation over the models of fold 0, see
// evidence/README.md. With 1, one in a hundred symmetries less is found, with 0 stated probabilities are too high.
constexpr double kHiddenNearWeight = 0.5;

double weightOf(const EvidenceSample& sample) {
  const bool is_near = sample.near_share >= kAsymmetric && sample.near_share < kSymmetric;
  const bool hides = kindOf(sample.evidence) == EvidenceKind::Scan || sample.row.rfind("cut off", 0) == 0;
  return is_near && hides ? kHiddenNearWeight : 1.0;
}

double quantileOf(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

KindFit fitKind(const std::vector<EvidenceSample>& samples, EvidenceKind kind, const EvidenceUnits& units) {
  std::vector<std::vector<double>> rows;
  std::vector<double> outcomes, weights, errors;
  KindFit fit;
  for (const EvidenceSample& sample : samples) {
    if (kindOf(sample.evidence) != kind) continue;
    // Intervals are read where a plane may be a symmetry.
    if (sample.evidence.share > kAsymmetric)
      errors.push_back((sample.share - sample.evidence.share) / shareUnit(sample.evidence));
    rows.push_back(logOddsTerms(sample.evidence, units));
    outcomes.push_back(isSymmetry(sample) ? 1.0 : 0.0);
    weights.push_back(weightOf(sample));
    ++(isSymmetry(sample) ? fit.num_symmetric : fit.num_asymmetric);
  }
  if (fit.num_symmetric == 0 || fit.num_asymmetric == 0)
    throw InputError(std::string("the models give no symmetric or no asymmetric planes of kind ") +
                     kKindNames[static_cast<std::size_t>(kind)]);
  const auto num_rows = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd terms(num_rows, rows.front().size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    terms.row(static_cast<Eigen::Index>(i)) = Eigen::Map<Eigen::RowVectorXd>(rows[i].data(), terms.cols());
  const LogisticCases cases{std::move(terms),
                            Eigen::Map<Eigen::VectorXd>(outcomes.data(), num_rows),
                            Eigen::Map<Eigen::VectorXd>(weights.data(), num_rows),
                            {}};
  fit.coefficients = fitWeightedLogistic(cases, 0.0, Eigen::VectorXd::Zero(cases.terms.cols()));
  fit.share_errors = {std::min(0.0, quantileOf(errors, kLowShare)), std::max(0.0, quantileOf(errors, kHighShare))};
  return fit;
}

/// Planes beside the best one of their cloud are further ones.
/// \param worth of a plane by itself.
template <typename Worth>
void markFurther(std::vector<EvidenceSample>& samples, const Worth& worth) {
  const auto is_same_cloud = [](const EvidenceSample& a, const EvidenceSample& b) {
    return a.model == b.model && a.row == b.row;
  };
  for (auto first = samples.begin(); first != samples.end();) {
    const auto last = std::find_if(first, samples.end(),
                                   [&](const EvidenceSample& sample) { return !is_same_cloud(*first, sample); });
    const auto best = std::max_element(
        first, last, [&](const EvidenceSample& a, const EvidenceSample& b) { return worth(a) < worth(b); });
    for (auto sample = first; sample != last; ++sample) sample->evidence.further = sample != best;
    first = last;
  }
}

/// Log odds of a plane as if it were the best of its cloud.
double oddsAlone(const EvidenceSample& sample, const DecisionFit& fit, const EvidenceUnits& units) {
  PlaneEvidence alone = sample.evidence;
  alone.further = false;
  return logOdds(alone, fit, units);
}

}  // namespace

bool isSymmetry(const EvidenceSample& sample) {
  return (kindOf(sample.evidence) == EvidenceKind::Volume ? sample.share : sample.near_share) >= kSymmetric;
}

DecisionFit fitDecision(std::vector<EvidenceSample>& samples, const EvidenceUnits& units) {
  DecisionFit fit;
  markFurther(samples, [](const EvidenceSample& sample) { return -sample.rank; });
  for (int pass = 0; pass < kFurtherPasses; ++pass) {
    for (const EvidenceKind kind : {EvidenceKind::Surface, EvidenceKind::Scan, EvidenceKind::Volume})
      fit[static_cast<std::size_t>(kind)] = fitKind(samples, kind, units);
    markFurther(samples, [&](const EvidenceSample& sample) { return oddsAlone(sample, fit, units); });
  }
  return fit;
}

std::array<double, 3> crossValidation(const std::vector<EvidenceSample>& samples, int num_parts) {
  std::set<std::string> names;
  for (const EvidenceSample& sample : samples) names.insert(sample.model);
  std::map<std::string, int> part_of;
  for (const std::string& name : names) part_of.emplace(name, static_cast<int>(part_of.size()) % num_parts);
  std::array<double, 3> losses{}, weights{};
  for (int part = 0; part < num_parts; ++part) {
    std::vector<EvidenceSample> others, judged;
    for (const EvidenceSample& sample : samples) (part_of[sample.model] == part ? judged : others).push_back(sample);
    const DecisionFit fit = fitDecision(others);
    markFurther(judged, [&](const EvidenceSample& sample) { return oddsAlone(sample, fit, {}); });
    for (const EvidenceSample& sample : judged) {
      const auto kind = static_cast<std::size_t>(kindOf(sample.evidence));
      const double odds = logOdds(sample.evidence, fit), weight = weightOf(sample);
      losses[kind] += weight * std::log1p(std::exp(isSymmetry(sample) ? -odds : odds));
      weights[kind] += weight;
    }
  }
  for (std::size_t kind = 0; kind < losses.size(); ++kind) losses[kind] /= weights[kind];
  return losses;
}

double logOdds(const PlaneEvidence& evidence, const DecisionFit& fit, const EvidenceUnits& units) {
  const std::vector<double> terms = logOddsTerms(evidence, units);
  const Eigen::VectorXd& coefficients = fit[static_cast<std::size_t>(kindOf(evidence))].coefficients;
  return Eigen::Map<const Eigen::VectorXd>(terms.data(), coefficients.size()).dot(coefficients);
}

std::string headerText(const DecisionFit& fit, std::size_t num_models, double tolerance) {
  std::string odds, errors;
  char text[64];
  for (const KindFit& kind : fit) {
    odds += odds.empty() ? "{" : ",\n                                            {";
    for (Eigen::Index k = 0; k < kind.coefficients.size(); ++k) {
      std::snprintf(text, sizeof(text), "%s%.4g", k > 0 ? ", " : "", kind.coefficients[k]);
      odds += text;
    }
    odds += "}";
    std::snprintf(text, sizeof(text), "%s{%.3g, %.3g}", errors.empty() ? "" : ", ", kind.share_errors.low,
                  kind.share_errors.high);
    errors += text;
  }
  std::snprintf(text, sizeof(text), "%zu models and shapes, tolerance %g of the diameter", num_models, tolerance);
  return "// Written by calibrate_planes; see README.md beside this file. Do not edit.\n#pragma once\n\n#include "
         "<array>\n#include <vector>\n\n#include \"core/evidence/plane_confidence.h\"\n\nnamespace pcl_symmetry "
         "{\n\n/// The fitted numbers of the decision, by EvidenceKind.\nstruct ConfidenceFit {\n  "
         "std::array<std::vector<double>, 3> log_odds;  ///< coefficients of logOddsTerms()\n  "
         "std::array<ShareInterval, 3> share_errors;    ///< of the share, units of shareUnit()\n};\n\n// clang-format "
         "off\n// fitted: " +
         std::string(text) + ".\ninline const ConfidenceFit kConfidenceFit{{{" + odds +
         "}},\n                                          {{" + errors +
         "}}};\n// clang-format on\n\n}  // namespace pcl_symmetry\n";
}

}  // namespace pcl_symmetry::apps
