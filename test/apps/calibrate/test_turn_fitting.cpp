#include "calibrate/turns/turn_fitting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/support/temporary_folder.h"
#include "common/command_line/tool_errors.h"
#include "core/base/random.h"
#include "core/detection/scan_axes/turn_confidence.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

/// Turns of each kind, whose log odds are 4 - 20 off.
std::vector<JudgedTurn> madeUpTurns() {
  std::vector<JudgedTurn> turns;
  RandomStream random(1);
  for (int i = 0; i < 1500; ++i) {
    JudgedTurn one;
    one.turn.fold = i % 3 == 0 ? 0 : i % 3 == 1 ? 2 : 3 + i % 5;
    one.turn.off = 0.4 * random.uniform();
    one.turn.far = 0.1 * random.uniform();
    one.turn.support = random.uniform();
    one.turn.halfway = one.turn.off + 0.3 * random.uniform();
    one.signs.grown = 1.0 + 0.5 * random.uniform();
    one.signs.hold = 0.1 * random.uniform();
    one.signs.planes_off = 0.2 * random.uniform();
    one.signs.beside = i % 2;
    const double probability = 1.0 / (1.0 + std::exp(20.0 * one.turn.off - 4.0));
    one.excess = random.uniform() < probability ? 0.5 : 3.0;
    turns.push_back(one);
  }
  return turns;
}

TEST(TurnFitting, StatedProbabilitiesComeTrue) {
  const std::vector<JudgedTurn> turns = madeUpTurns();
  const std::array<TurnFit, 3> fit = fitTurns(turns);
  double stated = 0.0;
  int num_likely = 0, num_right = 0, num_sure = 0, num_sure_right = 0;
  for (const JudgedTurn& one : turns) {
    const double confidence = confidenceOf(one, fit);
    stated += confidence;
    num_right += one.isRight();
    num_likely += confidence > 0.5;
    if (confidence <= 0.9) continue;
    ++num_sure;
    num_sure_right += one.isRight();
  }
  // A fit with a constant term has the mean of the cases, but for the pull of two cases in 500.
  EXPECT_NEAR(stated, num_right, 0.02 * num_right);
  EXPECT_GT(num_likely, 100);
  // derived: at 0.9 and 300 cases three standard errors are 0.05
  EXPECT_GT(num_sure, 100);
  EXPECT_GT(static_cast<double>(num_sure_right) / num_sure, 0.85);
}

TEST(TurnFitting, ATableGivesTheSameFit) {
  const TemporaryFolder folder;
  const std::vector<JudgedTurn> turns = madeUpTurns();
  const std::vector<JudgedTurn> read = readTurnTable(folder.write("turns.csv", turnTable({"made up"}, {turns})));
  ASSERT_EQ(read.size(), turns.size());
  // Tables have six digits.
  for (std::size_t i = 0; i < turns.size(); ++i) {
    EXPECT_NEAR(read[i].turn.off, turns[i].turn.off, 1e-6);
    EXPECT_NEAR(read[i].signs.hold, turns[i].signs.hold, 1e-6);
  }
  const std::array<TurnFit, 3> fit = fitTurns(turns), again = fitTurns(read);
  for (std::size_t kind = 0; kind < fit.size(); ++kind)
    EXPECT_LT((fit[kind].coefficients - again[kind].coefficients).cwiseAbs().maxCoeff(), 0.01) << kTurnKinds[kind];
  EXPECT_EQ(headerText(again), headerText(fitTurns(read)));
}

TEST(TurnFitting, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  EXPECT_THROW(fitTurns({}), InputError);
  EXPECT_THROW(readTurnTable(folder.write("wrong.csv", "a,b\n1,2\n")), InputError);
  EXPECT_THROW(readTurnTable(folder.write("short.csv", turnTable({}, {}) + "x,2,0.5\n")), InputError);
  EXPECT_THROW(readTurnTable(folder / "missing.csv"), InputError);
}

TEST(TurnFitting, ScansOfSolidsHaveTurnsThatAreSymmetries) {
  // The first solid of each half is round.
  const std::vector<JudgedTurn> turns = judgedTurnsOfSolid(0, false);
  ASSERT_FALSE(turns.empty());
  EXPECT_EQ(turns.front().turn.fold, 0);
  EXPECT_TRUE(turns.front().isRight());
  const std::vector<JudgedTurn> unpacked = unpackedTurns(packed(turns));
  ASSERT_EQ(unpacked.size(), turns.size());
  EXPECT_EQ(unpacked.front().excess, turns.front().excess);
  EXPECT_EQ(unpacked.back().signs.grown, turns.back().signs.grown);
}

}  // namespace
