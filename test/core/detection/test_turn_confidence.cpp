/// The probability of turns follows what was seen of them.
#include "core/detection/scan_axes/turn_confidence.h"

#include <gtest/gtest.h>

#include "core/detection/scan_axes/turn_confidence_fit.h"

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

TEST(TurnConfidence, FallsWithWhatLandsInEmptySpaceAndGrowsWithWhatLandsOnTheSurface) {
  for (const int fold : {0, 2, 6}) {
    const double clear = turnConfidence(turnOf(fold, 0.95, 0.0, 0.0, 0.4));
    EXPECT_GT(clear, 0.5) << fold;
    EXPECT_LT(clear, 1.0) << fold;
    EXPECT_LT(turnConfidence(turnOf(fold, 0.95, 0.1, 0.02, 0.5)), 0.3) << fold << ": a tenth contradicts";
    EXPECT_LT(turnConfidence(turnOf(fold, 0.2, 0.0, 0.0, 0.4)), clear) << fold << ": hardly anything confirms it";
  }
}

TEST(TurnConfidence, HasANumberForEachTerm) {
  for (const int fold : {0, 2, 6}) {
    const SymmetryTurn turn = turnOf(fold, 0.9, 0.01, 0.0, 0.2);
    EXPECT_EQ(turnOddsTerms(turn).size(), kTurnConfidenceFit[static_cast<std::size_t>(kindOf(turn))].size());
    EXPECT_EQ(turnOddsTerms(turn).front(), 1.0);
  }
}

}  // namespace
