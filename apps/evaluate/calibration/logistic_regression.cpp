#include "evaluate/calibration/logistic_regression.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace pcl_symmetry::apps {

namespace {

constexpr int kIterations = 100;    // chosen: Newton steps settle in about ten
constexpr double kRidge = 1e-3;     // chosen: a thousandth of a case; ten times as much changes no coefficient by 1 %
constexpr double kSettled = 1e-10;  // chosen: far below the digits that are written
constexpr double kGreatestOdds = 30.0;  // derived: exp(30) is beyond single precision of a probability

/// Newton steps for log odds terms * b, with a pull to 0 of its own for each coefficient.
Eigen::VectorXd solve(const Eigen::MatrixXd& terms, const Eigen::VectorXd& outcomes, const Eigen::VectorXd& weights,
                      const Eigen::VectorXd& ridge, Eigen::VectorXd b) {
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::ArrayXd odds = (terms * b).array().max(-kGreatestOdds).min(kGreatestOdds);
    const Eigen::ArrayXd p = 1.0 / (1.0 + (-odds).exp());
    const Eigen::ArrayXd weight = weights.array() * p * (1.0 - p);
    Eigen::MatrixXd hessian = terms.transpose() * weight.matrix().asDiagonal() * terms;
    hessian.diagonal() += ridge;
    const Eigen::VectorXd gradient =
        terms.transpose() * (weights.array() * (outcomes.array() - p)).matrix() - ridge.cwiseProduct(b);
    const Eigen::VectorXd step = hessian.ldlt().solve(gradient);
    b += step;
    if (step.cwiseAbs().maxCoeff() < kSettled) break;
  }
  return b;
}

}  // namespace

Eigen::VectorXd fitLogistic(const Eigen::MatrixXd& terms, const Eigen::VectorXd& outcomes) {
  return solve(terms, outcomes, Eigen::VectorXd::Ones(terms.rows()), Eigen::VectorXd::Constant(terms.cols(), kRidge),
               Eigen::VectorXd::Zero(terms.cols()));
}

Eigen::VectorXd fitWeightedLogistic(const LogisticCases& cases, double ridge, const Eigen::VectorXd& start) {
  Eigen::VectorXd pull =
      ridge / cases.weights.sum() * (cases.terms.array().square().matrix().transpose() * cases.weights);
  pull.array() += kRidge;
  pull[0] = kRidge;
  return solve(cases.terms, cases.outcomes, cases.weights, pull, start);
}

Eigen::VectorXd groupedErrors(const LogisticCases& cases, const Eigen::VectorXd& coefficients) {
  const Eigen::ArrayXd odds = (cases.terms * coefficients).array().max(-kGreatestOdds).min(kGreatestOdds);
  const Eigen::ArrayXd p = 1.0 / (1.0 + (-odds).exp());
  const Eigen::ArrayXd weight = cases.weights.array() * p * (1.0 - p);
  const Eigen::MatrixXd hessian = cases.terms.transpose() * weight.matrix().asDiagonal() * cases.terms;
  const int num_groups = 1 + *std::max_element(cases.groups.begin(), cases.groups.end());
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(cases.terms.cols(), num_groups);
  for (Eigen::Index i = 0; i < cases.terms.rows(); ++i)
    gradients.col(cases.groups[static_cast<std::size_t>(i)]) +=
        cases.weights[i] * (cases.outcomes[i] - p[i]) * cases.terms.row(i).transpose();
  const Eigen::MatrixXd steps = hessian.ldlt().solve(gradients);
  return steps.rowwise().norm();
}

}  // namespace pcl_symmetry::apps
