// Written by test/benchmark/fit_rotations.py --fold 0 --every 1 --solids 900; do not edit.
#pragma once

#include <array>
#include <vector>

namespace pcl_symmetry {

// Coefficients of rotationOddsTerms(), by RotationKind.
// Fitted; symmetries among the rotations of each kind: 333 of 434, 130 of 3994, 313 of 835.
inline const std::array<std::vector<double>, 3> kRotationConfidenceFit{
    {{2.204, -0.563, -3.65, -27.66},
     {-1.70, -0.756, -1.196, -11.52, -0.688, -0.690, -1.328},
     {2.86, -1.703, -1.15, -6.10, 11.96, -6.91}}};

}  // namespace pcl_symmetry
