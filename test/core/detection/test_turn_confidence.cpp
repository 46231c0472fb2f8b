/// The probability of turns follows what was seen of them.
#include "core/detection/turn_confidence.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace {

using namespace pcl_symmetry;

SymmetryTurn turnOf(int fold, double support, double off, double far, double halfway) {
  SymmetryTurn turn{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  turn.fold = fold;
  turn.support = support;
  turn.off = off;
  turn.far = far;
  turn.halfway = halfway;
  return turn;
}

/// What confirms a half turn.
TurnSigns clearSigns() {
  TurnSigns signs;
  signs.grown = 1.0;
  signs.hold = 0.1;
  signs.planes_off = 0.0;
  return signs;
}

double confidenceOf(int fold, double support, double off, double far, double halfway,
                    const TurnSigns& signs = clearSigns()) {
  return turnConfidence(turnOf(fold, support, off, far, halfway), signs);
}

TEST(TurnConfidence, FallsWithWhatLandsInEmptySpaceAndGrowsWithWhatLandsOnTheSurface) {
  for (const int fold : {0, 2, 6}) {
    const double clear = confidenceOf(fold, 0.95, 0.0, 0.0, 0.4);
    EXPECT_GT(clear, 0.5) << fold;
    EXPECT_LT(clear, 1.0) << fold;
    EXPECT_LT(confidenceOf(fold, 0.95, 0.1, 0.02, 0.5), 0.3) << fold << ": a tenth contradicts";
    EXPECT_LT(confidenceOf(fold, 0.2, 0.0, 0.0, 0.4), clear) << fold << ": hardly anything confirms it";
  }
}

TEST(TurnConfidence, OfAHalfTurnFallsWithEachSignAgainstIt) {
  const double clear = confidenceOf(2, 0.9, 0.0, 0.0, 0.4);
  // Each sign alone, from clear to clearly against.
  const std::array<std::pair<double TurnSigns::*, double>, 4> against{
      {{&TurnSigns::grown, 1.5}, {&TurnSigns::hold, 1e-9}, {&TurnSigns::planes_off, 0.3}, {&TurnSigns::beside, 1.0}}};
  for (std::size_t k = 0; k < against.size(); ++k) {
    const auto [sign, worst] = against[k];
    const double best = clearSigns().*sign;
    double last = clear;
    for (int step = 1; step <= 5; ++step) {
      TurnSigns signs = clearSigns();
      signs.*sign = best + (worst - best) * step / 5;
      const double confidence = confidenceOf(2, 0.9, 0.0, 0.0, 0.4, signs);
      EXPECT_LE(confidence, last) << "sign " << k << ", step " << step;
      last = confidence;
    }
    EXPECT_LT(last, 0.95 * clear) << "sign " << k;
  }
}

}  // namespace
