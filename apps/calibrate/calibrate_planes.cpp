/// Fits the numbers of the decision whether a plane is a symmetry, and writes the source that holds them.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "calibrate/evidence_samples.h"
#include "calibrate/logistic_regression.h"
#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/command_line/run_tool.h"
#include "common/shape_output/shape_output.h"
#include "core/base/parallel.h"
#include "evaluate/calibration/reliability.h"
#include "evaluate/shared/model_flags.h"
#include "evaluate/shared/table_text.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

// Shares of the surface: a symmetry has at least the first, an asymmetric plane less than the second. derived: the
// definition (evidence/README.md).
constexpr double kSymmetric = 0.97, kAsymmetric = 0.90;
// derived: 95 % of the errors lie between these shares of them.
constexpr double kLowShare = 0.025, kHighShare = 0.975;
constexpr std::array<const char*, 3> kKinds{"surface", "scan", "volume"};

struct CalibrationOptions {
  std::vector<std::string> folders;
  ModelSelection selection;
  double tolerance = 0.01;
  int num_shapes = 144;
  std::optional<std::string> csv, output;
  CommonOptions common;
};

CommandLine commandLine(CalibrationOptions& options) {
  CommandLine line("calibrate_planes", "Fits the numbers of the decision whether a plane is a symmetry.",
                   "calibrate_planes psb/train -classes train.cla -fold 0 -output src/core/evidence/confidence_fit.h");
  addModelFlags(line, options.folders, options.selection);
  line.number("tolerance", options.tolerance, Range::upTo(0, 0.1), "of a symmetry, as a share of the diameter")
      .number("shapes", options.num_shapes, Range::closed(0, 100'000),
              "number of clouds of shapes with folds, made by code")
      .text("csv", "FILE", options.csv, "a row for each plane: what the detector saw, and its true share")
      .text("output", "FILE.h", options.output, "C++ header with the numbers")
      .common(options.common, kThreads | kQuiet);
  return line;
}

bool isNear(const EvidenceSample& sample) {
  return sample.share >= kAsymmetric && sample.share < kSymmetric;
}

/// What a scan does not show cannot tell nearly symmetric planes from symmetries: of scans they are neither.
bool counts(const EvidenceSample& sample) {
  return !(kindOf(sample.evidence) == EvidenceKind::Scan && isNear(sample));
}

struct KindFit {
  Eigen::VectorXd coefficients;
  double low = 0.0, high = 0.0;  ///< errors of the share, units of shareUnit()
  int num_symmetric = 0, num_asymmetric = 0;
};

double quantileOf(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

KindFit fitKind(const std::vector<EvidenceSample>& samples, EvidenceKind kind) {
  std::vector<std::vector<double>> rows;
  std::vector<double> outcomes, errors;
  KindFit fit;
  for (const EvidenceSample& sample : samples) {
    if (kindOf(sample.evidence) != kind) continue;
    // Intervals are read where a plane may be a symmetry.
    if (sample.evidence.share > kAsymmetric)
      errors.push_back((sample.share - sample.evidence.share) / shareUnit(sample.evidence));
    if (!counts(sample)) continue;
    rows.push_back(logOddsTerms(sample.evidence));
    outcomes.push_back(sample.share >= kSymmetric ? 1.0 : 0.0);
    ++(sample.share >= kSymmetric ? fit.num_symmetric : fit.num_asymmetric);
  }
  if (fit.num_symmetric == 0 || fit.num_asymmetric == 0)
    throw InputError(std::string("the models give no symmetric or no asymmetric planes of kind ") +
                     kKinds[static_cast<std::size_t>(kind)]);
  Eigen::MatrixXd terms(rows.size(), rows.front().size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    terms.row(static_cast<Eigen::Index>(i)) = Eigen::Map<Eigen::RowVectorXd>(rows[i].data(), terms.cols());
  fit.coefficients = fitLogistic(terms, Eigen::Map<Eigen::VectorXd>(outcomes.data(), terms.rows()));
  fit.low = std::min(0.0, quantileOf(errors, kLowShare));
  fit.high = std::max(0.0, quantileOf(errors, kHighShare));
  return fit;
}

std::string csvText(const std::vector<EvidenceSample>& samples) {
  std::string text =
      "model,row,kind,share_on_mesh,share,unknown,support,conflict,baseline,score,own_score,spacing,tolerance,"
      "roughness\n";
  for (const EvidenceSample& sample : samples) {
    const PlaneEvidence& e = sample.evidence;
    text += Row()
                .add(sample.model)
                .add(sample.row)
                .add(kKinds[static_cast<std::size_t>(kindOf(e))])
                .add(sample.share)
                .add(e.share)
                .add(e.unknown)
                .add(e.support)
                .add(e.conflict)
                .add(e.baseline)
                .add(e.score)
                .add(e.own_score)
                .add(e.spacing)
                .add(e.tolerance)
                .add(e.roughness)
                .end();
  }
  return text;
}

std::string headerText(const std::array<KindFit, 3>& fits, std::size_t num_models, double tolerance) {
  std::string odds, errors;
  char text[64];
  for (const KindFit& fit : fits) {
    odds += odds.empty() ? "{" : ",\n      {";
    for (Eigen::Index k = 0; k < fit.coefficients.size(); ++k) {
      std::snprintf(text, sizeof(text), "%s%.4g", k > 0 ? ", " : "", fit.coefficients[k]);
      odds += text;
    }
    odds += "}";
    std::snprintf(text, sizeof(text), "%s{%.3g, %.3g}", errors.empty() ? "" : ", ", fit.low, fit.high);
    errors += text;
  }
  std::snprintf(text, sizeof(text), "%zu models, tolerance %g of the diameter", num_models, tolerance);
  return "// Written by calibrate_planes; see README.md beside this file. Do not edit.\n#pragma once\n\n#include "
         "<array>\n#include <vector>\n\n#include \"core/evidence/plane_confidence.h\"\n\nnamespace pcl_symmetry "
         "{\n\n/// The fitted numbers of the decision, by EvidenceKind.\nstruct ConfidenceFit {\n  "
         "std::array<std::vector<double>, 3> log_odds;  ///< coefficients of logOddsTerms()\n  "
         "std::array<ShareInterval, 3> share_errors;    ///< of the share, units of shareUnit()\n};\n\n// fitted: " +
         std::string(text) + ".\ninline const ConfidenceFit kConfidenceFit{\n    {{" + odds + "}},\n    {{" + errors +
         "}}};\n\n}  // namespace pcl_symmetry\n";
}

double logOdds(const PlaneEvidence& evidence, const std::array<KindFit, 3>& fits) {
  const std::vector<double> terms = logOddsTerms(evidence);
  const Eigen::VectorXd& coefficients = fits[static_cast<std::size_t>(kindOf(evidence))].coefficients;
  return Eigen::Map<const Eigen::VectorXd>(terms.data(), coefficients.size()).dot(coefficients);
}

/// Whether the stated probabilities come true, nearly symmetric planes of whole clouds counted as none.
void printReliabilities(const std::vector<EvidenceSample>& samples, const std::array<KindFit, 3>& fits) {
  std::array<std::vector<Forecast>, 3> forecasts;
  for (const EvidenceSample& sample : samples)
    if (counts(sample))
      forecasts[static_cast<std::size_t>(kindOf(sample.evidence))].push_back(
          {1.0 / (1.0 + std::exp(-logOdds(sample.evidence, fits))), sample.share >= kSymmetric});
  std::vector<Reliability> groups;
  for (std::size_t kind = 0; kind < forecasts.size(); ++kind)
    groups.push_back(reliabilityOf(kKinds[kind], forecasts[kind], {}));
  printReliability(groups);
}

/// Candidates of each kind of cloud: how many symmetries are decided, and how many others.
void printRows(const std::vector<EvidenceSample>& samples, const std::array<KindFit, 3>& fits) {
  struct Counts {
    int symmetric = 0, found = 0, asymmetric = 0, wrong = 0;
  };
  std::map<std::string, Counts> rows;
  for (const EvidenceSample& sample : samples) {
    const bool called = logOdds(sample.evidence, fits) >= 0.0;
    Counts& counts = rows[sample.row];
    if (sample.share >= kSymmetric) {
      ++counts.symmetric;
      counts.found += called ? 1 : 0;
    } else if (sample.share < kAsymmetric) {
      ++counts.asymmetric;
      counts.wrong += called ? 1 : 0;
    }
  }
  std::printf("%-16s %10s %8s %11s %8s\n", "candidates of", "symmetries", "decided", "asymmetric", "decided");
  for (const auto& [name, counts] : rows)
    std::printf("%-16s %10d %8d %11d %8d\n", name.c_str(), counts.symmetric, counts.found, counts.asymmetric,
                counts.wrong);
}

int run(int argc, char** argv) {
  CalibrationOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  const Console console(options.common.quiet);
  const std::vector<Model> models = listModels(options.folders, options.selection);
  const std::size_t num_all = models.size() + static_cast<std::size_t>(options.num_shapes);
  Step step(console,
            "Sampling " + std::to_string(models.size()) + " models, " + std::to_string(options.num_shapes) + " shapes");
  std::vector<std::vector<EvidenceSample>> all(num_all);
  std::vector<std::string> left_out(models.size());
  parallelBlocks(num_all, options.common.threads, [&](std::size_t i) {
    if (i >= models.size()) {
      all[i] = sampleFoldedEvidence(static_cast<int>(i - models.size()), options.tolerance);
      return;
    }
    try {
      all[i] = sampleEvidence(models[i], options.tolerance);
    } catch (const std::exception& error) {
      left_out[i] = models[i].path + ": " + error.what();
    }
  });
  std::vector<EvidenceSample> samples;
  std::size_t num_models = 0;
  for (std::size_t i = 0; i < num_all; ++i) {
    samples.insert(samples.end(), all[i].begin(), all[i].end());
    num_models += i >= models.size() || all[i].empty() ? 0 : 1;
    if (i < models.size() && !left_out[i].empty()) console.warn("left out: " + left_out[i]);
  }
  step.done(std::to_string(samples.size()) + " planes of " + std::to_string(num_models) + " models");
  std::array<KindFit, 3> fits;
  for (std::size_t kind = 0; kind < fits.size(); ++kind) {
    fits[kind] = fitKind(samples, static_cast<EvidenceKind>(kind));
    std::printf("%-8s %5d symmetric, %5d asymmetric planes\n", kKinds[kind], fits[kind].num_symmetric,
                fits[kind].num_asymmetric);
  }
  printRows(samples, fits);
  printReliabilities(samples, fits);
  const std::string header = headerText(fits, num_models, options.tolerance);
  std::printf("%s", header.c_str());
  if (options.csv) writeText(*options.csv, csvText(samples));
  if (options.output) writeText(*options.output, header);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
