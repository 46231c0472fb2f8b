// Written by test/benchmark/fit_registration.py --fold 0 --every 6; do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of the terms of poseConfidence().
inline constexpr std::array<double, 7> kRegistrationFit{0.09, 0.424, 0.611, 5.08, -1.71, -1.433, -4.10};

}  // namespace pcl_symmetry
