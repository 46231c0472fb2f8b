#include "calibrate/logistic_regression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

TEST(LogisticRegression, FindsTheCoefficientsThatMadeTheOutcomes) {
  constexpr int kCases = 20'000;
  const Eigen::Vector3d truth(-0.5, 2.0, -1.0);
  RandomStream random(7);
  Eigen::MatrixXd terms(kCases, 3);
  Eigen::VectorXd outcomes(kCases);
  for (int i = 0; i < kCases; ++i) {
    terms.row(i) << 1.0, 2.0 * random.uniform() - 1.0, 4.0 * random.uniform() - 2.0;
    outcomes[i] = random.uniform() < 1.0 / (1.0 + std::exp(-terms.row(i).dot(truth))) ? 1.0 : 0.0;
  }
  const Eigen::VectorXd found = fitLogistic(terms, outcomes);
  // Standard errors are below 0.04.
  EXPECT_LT((found - truth).cwiseAbs().maxCoeff(), 0.15) << found.transpose();
}

TEST(LogisticRegression, StaysFiniteWhereTheCasesCanBeSeparated) {
  Eigen::MatrixXd terms(4, 2);
  terms << 1, -2, 1, -1, 1, 1, 1, 2;
  const Eigen::VectorXd found = fitLogistic(terms, Eigen::Vector4d(0, 0, 1, 1));
  EXPECT_TRUE(found.allFinite());
  EXPECT_GT(found[1], 1.0);
}

}  // namespace
