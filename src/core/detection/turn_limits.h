#pragma once

#include <algorithm>

#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

// Shares of the points seen that the worst turn may throw into empty space, and farther than ten tolerances there: of
// folds and of round bodies. measured: scans of shapes made by code, tuning half; 0.000 and 0.000 of round
// bodies, 0.024 and 0.009 of a mug whose handle is 2.5 % of what is seen. chosen: folds are given as much as features
// of whole objects, halved; twice takes shallow features for symmetric.
constexpr double kMostOff = 0.05, kMostFar = 0.0125, kMostRoundOff = 0.015, kMostRoundFar = 0.004;
// Shares that land on the surface by small turns of a round body, by the best turn of a fold, and of fold 2 (of which
// most is hidden). chosen: half lists turns that nothing seen confirms, twice loses slender bodies.
constexpr double kRoundOn = 0.6, kFoldOn = 0.3, kHalfTurnOn = 0.75;
// By how much more the turns halfway throw into empty space. chosen: half lets chance choose folds of round bodies,
// twice loses shallow folds.
constexpr double kHalfwayMore = 0.06;

/// The least margin to a limit, >= 0 where all are kept: by it the orders of a line and the lines are compared. What is
/// reported is turnConfidence(), which is fitted to lines that were chosen so.
/// \param turn with the shares that were seen.
inline double marginOf(const SymmetryTurn& turn) {
  const double least_on = turn.fold == 0 ? kRoundOn : turn.fold == 2 ? kHalfTurnOn : kFoldOn;
  const double most_off = turn.fold == 0 ? kMostRoundOff : kMostOff,
               most_far = turn.fold == 0 ? kMostRoundFar : kMostFar;
  const double margin = std::min({1.0 - turn.off / most_off, 1.0 - turn.far / most_far, turn.support / least_on - 1.0});
  return turn.fold == 0 ? margin : std::min(margin, (turn.halfway - turn.off) / kHalfwayMore - 1.0);
}

}  // namespace pcl_symmetry
