#include "calibrate/logistic_regression.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace pcl_symmetry::apps {

namespace {

constexpr int kIterations = 100;    // chosen: Newton steps settle in about ten
constexpr double kRidge = 1e-3;     // chosen: a thousandth of a case; ten times as much changes no coefficient by 1 %
constexpr double kSettled = 1e-10;  // chosen: far below the digits that are written
constexpr double kGreatestOdds = 30.0;  // derived: exp(30) is beyond single precision of a probability

}  // namespace

Eigen::VectorXd fitLogistic(const Eigen::MatrixXd& terms, const Eigen::VectorXd& outcomes) {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(terms.cols());
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::ArrayXd odds = (terms * b).array().max(-kGreatestOdds).min(kGreatestOdds);
    const Eigen::ArrayXd p = 1.0 / (1.0 + (-odds).exp());
    const Eigen::ArrayXd weight = p * (1.0 - p);
    Eigen::MatrixXd hessian = terms.transpose() * weight.matrix().asDiagonal() * terms;
    hessian.diagonal().array() += kRidge;
    const Eigen::VectorXd gradient = terms.transpose() * (outcomes.array() - p).matrix() - kRidge * b;
    const Eigen::VectorXd step = hessian.ldlt().solve(gradient);
    b += step;
    if (step.cwiseAbs().maxCoeff() < kSettled) break;
  }
  return b;
}

}  // namespace pcl_symmetry::apps
