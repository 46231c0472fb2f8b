// Written by test/benchmark/fit_registration.py --fold 0 --every 6; do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of the terms of poseConfidence().
inline constexpr std::array<double, 7> kRegistrationFit{-0.43, 0.773, 0.268, 5.74, -2.91, -1.151, -8.14};

}  // namespace pcl_symmetry
