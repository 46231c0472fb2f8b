// Written by test/benchmark/fit_registration.py --fold 0 --every 6; do not edit.
#pragma once

#include <array>

namespace pcl_symmetry {

/// Weights of the terms of poseConfidence().
inline constexpr std::array<double, 7> kRegistrationFit{-2.77, 0.583, 3.71, -29.0, -1.424, -1.000, -7.53};

}  // namespace pcl_symmetry
