/// Logistic regression, by iteratively reweighted least squares.
#pragma once

#include <Eigen/Core>

namespace pcl_symmetry::apps {

/// \param terms one row a case; the first column is 1.
/// \param outcomes one a case, 0 or 1.
/// \return coefficients b that maximise the likelihood of P(1) = 1 / (1 + exp(-terms * b)), with a weak pull to 0 that
/// keeps them finite where the cases can be separated.
Eigen::VectorXd fitLogistic(const Eigen::MatrixXd& terms, const Eigen::VectorXd& outcomes);

}  // namespace pcl_symmetry::apps
