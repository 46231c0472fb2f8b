#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "evaluate/calibration/reliability.h"
#include "evaluate/shared/proportion.h"

namespace {

using namespace pcl_symmetry::apps;

TEST(Proportion, WilsonsIntervalSolvesItsEquation) {
  for (const auto& [count, total] : {std::make_pair(0, 1), {1, 49}, {212, 217}, {30, 30}, {5, 10}}) {
    const Proportion proportion{count, total};
    const Interval interval = proportion.wilson();
    // The borders are the rates p from which the observed one lies 1.96 standard errors sqrt(p (1 - p) / n) away.
    for (const double p : {interval.low, interval.high}) {
      if (p < 1e-12 || p > 1.0 - 1e-12) continue;  // where the observed rate is 0 or 1 one border is that rate
      EXPECT_NEAR(std::abs(proportion.rate() - p), 1.959964 * std::sqrt(p * (1.0 - p) / total), 1e-6);
    }
    EXPECT_LE(interval.low, proportion.rate() + 1e-12);
    EXPECT_GE(interval.high, proportion.rate() - 1e-12);
  }
}

TEST(Proportion, NothingCountedSaysNothing) {
  const Proportion none;
  EXPECT_TRUE(std::isnan(none.rate()));
  EXPECT_EQ(none.wilson().low, 0.0);
  EXPECT_EQ(none.wilson().high, 1.0);
  EXPECT_EQ(none.text(), "-");
  EXPECT_EQ((Proportion{1, 2}.text().substr(0, 11)), "50.0 % of 2");
}

TEST(Reliability, ProbabilitiesThatComeTrueHaveNoError) {
  std::vector<Forecast> forecasts;
  for (int i = 0; i < 20; ++i) forecasts.push_back({0.75, i < 15});
  const Reliability exact = reliabilityOf("exact", forecasts, {});
  EXPECT_NEAR(exact.calibration_error, 0.0, 1e-12);
  EXPECT_NEAR(exact.brier, 0.75 * 0.25, 1e-12) << "the variance of a coin that falls right in three of four throws";
  EXPECT_EQ(exact.bins[7].right.count, 15);
  EXPECT_EQ(exact.bins[7].right.total, 20);
  EXPECT_NEAR(exact.bins[7].meanConfidence(), 0.75, 1e-12);

  const Reliability boastful = reliabilityOf("boastful", {{1.0, false}, {1.0, true}, {0.0, false}, {0.0, false}}, {});
  EXPECT_NEAR(boastful.calibration_error, 0.25, 1e-12) << "half of the answers are half too sure";
  EXPECT_NEAR(boastful.brier, 0.25, 1e-12);
  EXPECT_TRUE(std::isnan(reliabilityOf("none", {}, {}).brier));
  EXPECT_TRUE(std::isnan(reliabilityOf("none", {}, {}).chance_error));
}

TEST(Reliability, ChanceLeavesTheMeanDeviationOfItsDraws) {
  // Of 20 draws of probability 3/4, de Moivre's 2 k C(20, k) p^k q^(21 - k) / 20 with k = 16 is 0.0759; 200 means of
  // draws with a deviation of 0.058 each lie within 0.0125 of it, three standard errors.
  const Reliability one_bin = reliabilityOf("", std::vector<Forecast>(20, {0.75, true}), {});
  EXPECT_NEAR(one_bin.chance_error, 0.0759, 0.0125);
  EXPECT_NEAR(reliabilityOf("", {{1.0, false}, {0.0, true}}, {}).chance_error, 0.0, 1e-12)
      << "nothing is left to chance";
}

TEST(Reliability, CloudsAreBinnedByTheShareOfTheirBestPlane) {
  const Reliability curve =
      reliabilityOf("", {}, {{0.0, false}, {0.89, false}, {0.9, true}, {0.97, true}, {1.0, false}});
  int num_cases = 0;
  for (const ShareBin& bin : curve.shares) {
    num_cases += bin.called.total;
    if (bin.low == 0.85) {
      EXPECT_EQ(bin.called.total, 1) << "0.89";
    }
    if (bin.low == 0.9) {
      EXPECT_EQ(bin.called.count, 1) << "borders belong to the upper bin";
    }
    if (bin.high == 1.0) {
      EXPECT_EQ(bin.called.total, 1) << "the last bin has both of its borders";
    }
  }
  EXPECT_EQ(num_cases, 5);
  const std::string rows = shareCSV({curve});
  EXPECT_EQ(static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n')), curve.shares.size() + 1);
}

}  // namespace
