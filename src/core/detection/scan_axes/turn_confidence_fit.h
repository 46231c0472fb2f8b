// Written by calibrate_turns. Do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of turnOddsTerms(), by TurnKind.
// fitted: symmetries among the turns of each kind: 177 of 218, 68 of 1963, 149 of 375.
inline const std::array<std::vector<double>, 3> kTurnConfidenceFit{
    {{2.055, -0.1166, -3.876, -16.88},
     {-1.566, -0.8895, -0.2387, -0.5774, -9.52, -0.7103, -0.6933, -1.01},
     {3.053, -1.596, -1.069, -7.227, 10.89, -6.353}}};

}  // namespace pcl_symmetry
