// Written by calibrate_turns. Do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of turnOddsTerms(), by TurnKind.
// fitted: symmetries among the turns of each kind: 177 of 218, 67 of 1957, 149 of 375.
inline const std::array<std::vector<double>, 3> kTurnConfidenceFit{
    {{2.055, -0.1166, -3.876, -16.88},
     {-1.537, -0.9273, -0.2283, -0.484, -9.637, -0.7094, -0.6752, -1.022},
     {3.053, -1.596, -1.069, -7.227, 10.89, -6.353}}};

}  // namespace pcl_symmetry
