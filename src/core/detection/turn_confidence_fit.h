// Written by test/benchmark/fit_turns.py --fold 0 --every 1 --solids 1080; do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of turnOddsTerms(), by TurnKind.
// Fitted; symmetries among the turns of each kind: 393 of 500, 130 of 3994, 369 of 938.
inline const std::array<std::vector<double>, 3> kTurnConfidenceFit{
    {{2.302, -0.452, -3.75, -29.50},
     {-1.68, -0.758, -1.206, -11.57, -0.685, -0.689, -1.311},
     {2.96, -1.751, -1.21, -6.33, 12.53, -7.19}}};

}  // namespace pcl_symmetry
