// Written by calibrate_turns. Do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of turnOddsTerms(), by TurnKind. fitted: none.
inline const std::array<std::vector<double>, 3> kTurnConfidenceFit{
    {{0.0, -1.0, -1.0, 4.0}, {-12.0, -1.0, -0.5, 4.0, 1.0}, {-10.0, -1.0, -0.5, 2.0, 6.0, 1.0}}};

}  // namespace pcl_symmetry
