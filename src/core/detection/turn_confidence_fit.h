// Written by test/benchmark/fit_turns.py --fold 0 --every 1 --solids 1080; do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of turnOddsTerms(), by TurnKind.
// Fitted; symmetries among the turns of each kind: 393 of 504, 130 of 3995, 369 of 938.
inline const std::array<std::vector<double>, 3> kTurnConfidenceFit{
    {{2.281, -0.575, -3.82, -28.74},
     {-1.70, -0.756, -1.195, -11.53, -0.688, -0.690, -1.328},
     {2.96, -1.751, -1.21, -6.33, 12.53, -7.19}}};

}  // namespace pcl_symmetry
