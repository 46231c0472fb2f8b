#include "evaluate/calibration/logistic_regression.h"

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

TEST(LogisticRegression, SharesAndWeightsCountAsCasesDo) {
  // Two cases, one of them three times, are the same as four cases; a share of 1/3 is one of three.
  LogisticCases cases{Eigen::MatrixXd(2, 2), Eigen::VectorXd(2), Eigen::VectorXd(2), {0, 1}};
  cases.terms << 1, 0, 1, 1;
  cases.outcomes << 0.5, 1.0 / 3.0;
  cases.weights << 40, 30;
  const Eigen::VectorXd found = fitWeightedLogistic(cases, 0.0, Eigen::VectorXd::Zero(2));
  EXPECT_NEAR(found[0], 0.0, 1e-3);
  EXPECT_NEAR(found[1], std::log(0.5), 1e-3) << "log odds of 1/3, less those of 1/2";
  const Eigen::VectorXd pulled = fitWeightedLogistic(cases, 100.0, Eigen::VectorXd::Zero(2));
  EXPECT_LT(std::abs(pulled[1]), 0.5 * std::abs(found[1]));
}

TEST(LogisticRegression, ErrorsShrinkWithTheNumberOfGroups) {
  RandomStream random(3);
  const auto errorOf = [&](int num_groups) {
    constexpr int kCasesOfGroup = 5;
    const Eigen::Index size = num_groups * kCasesOfGroup;
    LogisticCases cases{Eigen::MatrixXd::Ones(size, 1), Eigen::VectorXd(size), Eigen::VectorXd::Ones(size), {}};
    for (Eigen::Index i = 0; i < size; ++i) {
      cases.outcomes[i] = random.uniform() < 0.5 ? 1.0 : 0.0;
      cases.groups.push_back(static_cast<int>(i) / kCasesOfGroup);
    }
    return groupedErrors(cases, fitWeightedLogistic(cases, 0.0, Eigen::VectorXd::Zero(1)))[0];
  };
  // derived: the error of log odds near 0 from n independent cases is 2 / sqrt(n).
  EXPECT_NEAR(errorOf(400), 2.0 / std::sqrt(2000.0), 0.01);
  EXPECT_NEAR(errorOf(1600), 2.0 / std::sqrt(8000.0), 0.004);
}

}  // namespace
