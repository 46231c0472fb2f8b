#pragma once

#include <vector>

#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Free space on the cells of a distance transform: 1 - f where the scanner looked through the cell, 0 elsewhere.
/// \param visibility in the frame of the EDT; null for a whole object.
/// \return one value in [0, 1] per cell, x fastest; none without visibility.
std::vector<float> freeSpace(const GaussianEdt& edt, const Visibility* visibility, int num_threads = 0);

/// Symmetry of a scan with respect to a plane. A departure from the paper, whose measure is D alone: reflected points
/// in space that the scanner saw to be empty speak against the plane.
/// \param d D of Equation 2, >= 0.
/// \param f F, the same correlation of f with the reflected free space, >= 0.
/// \return (1 + c) D / (D + F + c) with c = 0.15; 1 for D = 1 and F = 0. A plane that maps the surface to unknown space
/// has D = F = 0 and the value 0.
inline double seenSymmetry(double d, double f) {
  // With this value the first axis of 53 % of 160 scans of training models comes within 5 degrees, of 36 % by
  // D alone.
  constexpr double kDoubt = 0.15;
  return (1.0 + kDoubt) * d / (d + f + kDoubt);
}

}  // namespace pcl_symmetry
