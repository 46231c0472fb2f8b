// Written by calibrate_turns. Do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of turnOddsTerms(), by TurnKind.
// fitted: symmetries among the turns of each kind: 177 of 218, 193 of 3170, 149 of 375.
inline const std::array<std::vector<double>, 3> kTurnConfidenceFit{{{2.055, -0.1166, -3.876, -16.88},
                                                                    {0.4993, -1.103, -1.778, -5.725, 4.666},
                                                                    {3.053, -1.596, -1.069, -7.227, 10.89, -6.353}}};

}  // namespace pcl_symmetry
