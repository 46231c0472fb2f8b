/// Logistic regression, by iteratively reweighted least squares.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pcl_symmetry::apps {

/// \param terms one row a case; the first column is 1.
/// \param outcomes one a case, 0 or 1.
/// \return coefficients b that maximise the likelihood of P(1) = 1 / (1 + exp(-terms * b)), with a weak pull to 0 that
/// keeps them finite where the cases can be separated.
Eigen::VectorXd fitLogistic(const Eigen::MatrixXd& terms, const Eigen::VectorXd& outcomes);

/// Cases that count differently, with outcomes that are shares.
struct LogisticCases {
  Eigen::MatrixXd terms;     ///< one row a case; the first column is 1
  Eigen::VectorXd outcomes;  ///< in [0, 1]
  Eigen::VectorXd weights;   ///< >= 0
  std::vector<int> groups;   ///< of each case, from 0: cases of one group belong together
};

/// As fitLogistic().
/// \param ridge pull to 0 on coefficients of terms that are scaled to a weighted mean square of 1, in cases; the first
/// coefficient is pulled by a thousandth of a case alone.
/// \param start where the search begins.
Eigen::VectorXd fitWeightedLogistic(const LogisticCases& cases, double ridge, const Eigen::VectorXd& start);

/// Standard errors of fitted coefficients, from the spread of the gradients of the groups (sandwich estimator).
Eigen::VectorXd groupedErrors(const LogisticCases& cases, const Eigen::VectorXd& coefficients);

}  // namespace pcl_symmetry::apps
