// Written by test/benchmark/fit_registration.py --fold 0 --every 6; do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of the terms of poseConfidence().
inline constexpr std::array<double, 7> kRegistrationFit{-1.35, 0.484, 0.470, 5.23, -1.47, -0.714, -4.19};

}  // namespace pcl_symmetry
