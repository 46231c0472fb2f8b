#pragma once

#include <array>

namespace pcl_symmetry {

inline constexpr std::array<double, 7> kRegistrationFit{-11.82, 0.5, 1.4, 9.08, -2.31, -1.64, -3.09};

}  // namespace pcl_symmetry
