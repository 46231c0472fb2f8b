// Written by test/benchmark/fit_registration.py --fold 0 --every 6; do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of the terms of poseConfidence().
inline constexpr std::array<double, 7> kRegistrationFit{-0.61, 0.834, 0.082, 5.65, -3.69, -1.193, -8.67};

}  // namespace pcl_symmetry
