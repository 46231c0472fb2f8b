// Written by calibrate_turns. Do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of turnOddsTerms(), by TurnKind.
// fitted: symmetries among the turns of each kind: 177 of 219, 68 of 1979, 166 of 350.
inline const std::array<std::vector<double>, 3> kTurnConfidenceFit{
    {{2.072, -0.05091, -3.947, -17.37},
     {-1.65, -0.8739, -0.7086, -9.721, -0.7114, -0.8031, -0.8247},
     {3.767, -1.595, -1.418, -7.529, 9.117, -3.358}}};

}  // namespace pcl_symmetry
