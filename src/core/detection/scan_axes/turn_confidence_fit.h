// Written by calibrate_turns. Do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of turnOddsTerms(), by TurnKind.
// fitted: symmetries among the turns of each kind: 177 of 219, 70 of 2026, 168 of 345.
inline const std::array<std::vector<double>, 3> kTurnConfidenceFit{
    {{2.062, -0.05684, -3.933, -17.04},
     {-1.648, -0.7303, -1.091, -10.72, -0.7635, -0.9233, -0.7037},
     {2.813, -1.502, -1.421, -7.243, 11.17, -2.497}}};

}  // namespace pcl_symmetry
