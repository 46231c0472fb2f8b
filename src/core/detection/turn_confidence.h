#pragma once

#include <vector>

#include "core/detection/turn_signs.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// Turns whose confidences have numbers of their own: a half turn hides most of what it says.
enum class TurnKind { AnyAngle, Half, Folds };

TurnKind kindOf(const SymmetryTurn& turn);

/// Terms of the log odds that turns which a scan shows are symmetries of the whole object; the first is 1. The numbers
/// that they are multiplied with are fitted by test/benchmark/fit_turns.py.
/// \param turn with the shares that were seen.
std::vector<double> turnOddsTerms(const SymmetryTurn& turn, const TurnSigns& signs);

/// Probability that the turns map at least 90 % of the whole surface to within 1 % of the diameter of the surface, and
/// all but 1.25 % to within ten times that: the limits of ObjectSymmetryOptions.
/// \param turn with the shares that were seen.
double turnConfidence(const SymmetryTurn& turn, const TurnSigns& signs);

}  // namespace pcl_symmetry
