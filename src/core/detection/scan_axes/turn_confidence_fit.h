// Written by calibrate_turns. Do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of turnOddsTerms(), by TurnKind. fitted: none.
inline const std::array<std::vector<double>, 3> kTurnConfidenceFit{{{3.0, -1.0, -1.0, -4.0},
                                                                    {1.0, -1.0, -1.0, -7.0, 1.0},
                                                                    {2.0, -1.0, -1.0, -4.0, 5.0, 0.0}}};

}  // namespace pcl_symmetry
