// Written by test/benchmark/fit_registration.py --fold 0 --every 6; do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of the terms of poseConfidence().
inline constexpr std::array<double, 7> kRegistrationFit{-0.53, 0.786, 5.06, -26.2, -6.44, -0.915, -9.00};

}  // namespace pcl_symmetry
