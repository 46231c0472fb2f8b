#pragma once

#include <vector>

#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"
#include "pcl_symmetry/core/scan/visibility.h"

namespace pcl_symmetry {

/// Free space on the cells of a distance transform: (1 - f) where the scanner looked through the cell, 0 elsewhere.
/// \return one value in [0, 1] per cell, x fastest.
std::vector<float> freeSpace(const GaussianEdt& edt, const Visibility& visibility, int num_threads = 0);

/// What a scan says about a plane: D, and F = the same correlation of f with the free space, speaking against it.
/// \return (1 + c) D / (D + F + c) with c = 0.15, in [0, 1]; 1 for D = 1 and F = 0. A plane that maps the surface to
/// where the scanner could not look has D = F = 0 and no merit.
inline double seenSymmetry(double d, double f) {
  constexpr double kDoubt = 0.15;
  return (1.0 + kDoubt) * d / (d + f + kDoubt);
}

}  // namespace pcl_symmetry
