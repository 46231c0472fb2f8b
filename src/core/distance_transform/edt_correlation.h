#pragma once

#include <algorithm>
#include <vector>

#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"

namespace pcl_symmetry {

/// Where a motion takes the cells of a row, in cells: cell x goes to first + x * step.
struct ImageOfRow {
  Eigen::Vector3d first, step;
};

/// Writes products[x] = f(x) f(image of x) for some cells of a row.
/// \param f of the row.
/// \param cells [begin, end) of the row.
/// \param products of the row.
using RowProducts = void (*)(const GaussianEdt& edt, const float* f, const ImageOfRow& image, GaussianEdt::Range cells,
                             double* products);

/// \return the fastest that this processor supports; all write the same bytes.
RowProducts rowProducts();

/// D of Equation 2 for one motion of space, a reflection or a rotation: the full sum over the cells of the EDT.
/// \param image maps a position to its image, both in cells from the center of cell (0, 0, 0).
/// \param step image of the unit vector along x, as a direction.
/// \return D in [0, 1].
template <typename Image>
double correlation(const GaussianEdt& edt, const Image& image, const Eigen::Vector3d& step) {
  const int n = edt.numCells();
  const float* f = edt.values().data();
  const GaussianEdt::Range* filled = edt.filledRanges().data();
  const RowProducts fill = rowProducts();
  std::vector<double> products(static_cast<std::size_t>(n));
  double sum = 0.0;
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y, f += n, ++filled) {
      if (filled->begin == filled->end) continue;
      fill(edt, f, {image(Eigen::Vector3d(0.0, y, z)), step}, *filled, products.data());
      for (int x = filled->begin; x < filled->end; ++x) sum += products[static_cast<std::size_t>(x)];
    }
  }
  return std::clamp(sum / edt.sqNorm(), 0.0, 1.0);
}

}  // namespace pcl_symmetry
