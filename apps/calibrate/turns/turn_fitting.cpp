#include "calibrate/turns/turn_fitting.h"

#include <cmath>
#include <cstdio>

#include "common/command_line/tool_errors.h"
#include "core/detection/scan_axes/turn_confidence.h"
#include "evaluate/calibration/logistic_regression.h"

namespace pcl_symmetry::apps {

namespace {

// Pull on the scaled coefficients, in cases. chosen: half and twice change no confidence by 0.05; without any, a kind
// whose cases can be separated would be sure of everything.
constexpr double kPull = 0.5;

TurnFit fitKind(const std::vector<JudgedTurn>& turns, TurnKind kind) {
  TurnFit fit;
  std::vector<std::vector<double>> rows;
  std::vector<double> outcomes;
  for (const JudgedTurn& one : turns) {
    // Solids made by code have half turns more often than objects have: prisms have as many as faces.
    if (kindOf(one.turn) != kind || (kind == TurnKind::Half && one.of_solid)) continue;
    rows.push_back(turnOddsTerms(one.turn, one.signs));
    outcomes.push_back(one.isRight() ? 1.0 : 0.0);
    ++(one.isRight() ? fit.num_right : fit.num_wrong);
  }
  if (fit.num_right == 0 || fit.num_wrong == 0)
    throw InputError(std::string("no turns that are symmetries, or no others: ") +
                     kTurnKinds[static_cast<std::size_t>(kind)]);
  LogisticCases cases;
  cases.terms.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows.front().size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    cases.terms.row(static_cast<Eigen::Index>(i)) = Eigen::Map<Eigen::RowVectorXd>(rows[i].data(), cases.terms.cols());
  cases.outcomes = Eigen::Map<Eigen::VectorXd>(outcomes.data(), cases.terms.rows());
  cases.weights = Eigen::VectorXd::Ones(cases.terms.rows());
  fit.coefficients = fitWeightedLogistic(cases, kPull, Eigen::VectorXd::Zero(cases.terms.cols()));
  return fit;
}

}  // namespace

std::array<TurnFit, 3> fitTurns(const std::vector<JudgedTurn>& turns) {
  return {fitKind(turns, TurnKind::AnyAngle), fitKind(turns, TurnKind::Half), fitKind(turns, TurnKind::Folds)};
}

double confidenceOf(const JudgedTurn& one, const std::array<TurnFit, 3>& fit) {
  const std::vector<double> terms = turnOddsTerms(one.turn, one.signs);
  const Eigen::VectorXd& coefficients = fit[static_cast<std::size_t>(kindOf(one.turn))].coefficients;
  return 1.0 /
         (1.0 + std::exp(-Eigen::Map<const Eigen::VectorXd>(terms.data(), coefficients.size()).dot(coefficients)));
}

std::string headerText(const std::array<TurnFit, 3>& fit) {
  std::string numbers, counts;
  char text[64];
  for (std::size_t kind = 0; kind < fit.size(); ++kind) {
    numbers += kind == 0 ? "{" : ",\n     {";
    for (Eigen::Index k = 0; k < fit[kind].coefficients.size(); ++k) {
      std::snprintf(text, sizeof(text), "%s%.4g", k > 0 ? ", " : "", fit[kind].coefficients[k]);
      numbers += text;
    }
    numbers += "}";
    std::snprintf(text, sizeof(text), "%s%d of %d", kind > 0 ? ", " : "", fit[kind].num_right,
                  fit[kind].num_right + fit[kind].num_wrong);
    counts += text;
  }
  return "// Written by calibrate_turns. Do not edit.\n#pragma once\n\n#include <array>\n#include <vector>\n\n"
         "namespace pcl_symmetry {\n\n// Coefficients of turnOddsTerms(), by TurnKind.\n"
         "// fitted: symmetries among the turns of each kind: " +
         counts + ".\ninline const std::array<std::vector<double>, 3> kTurnConfidenceFit{\n    {" + numbers +
         "}};\n\n}  // namespace pcl_symmetry\n";
}

}  // namespace pcl_symmetry::apps
