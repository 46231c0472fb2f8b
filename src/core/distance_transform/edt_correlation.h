#pragma once

#include <algorithm>

#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"

namespace pcl_symmetry {

/// D of Equation 2 for one motion of space, a reflection or a rotation: the full sum over the cells of the EDT.
/// \param image maps a position to its image, both in cells from the center of cell (0, 0, 0).
/// \param step image of the unit vector along x, as a direction.
/// \return D in [0, 1].
template <typename Image>
double correlation(const GaussianEdt& edt, const Image& image, const Eigen::Vector3d& step) {
  const int n = edt.numCells();
  const float* f = edt.values().data();
  const GaussianEdt::Range* filled = edt.filledRanges().data();
  double sum = 0.0;
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y, f += n, ++filled) {
      if (filled->begin == filled->end) continue;
      const Eigen::Vector3d first = image(Eigen::Vector3d(0.0, y, z));
      for (int x = filled->begin; x < filled->end; ++x)
        if (f[x] > 0.0f) sum += f[x] * edt.atCell(first + x * step);
    }
  }
  return std::clamp(sum / edt.sqNorm(), 0.0, 1.0);
}

}  // namespace pcl_symmetry
