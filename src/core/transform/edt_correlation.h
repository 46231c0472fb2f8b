#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/base/parallel.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

/// Where a motion takes the cells of a row, in cells: cell x goes to first + x * step.
struct ImageOfRow {
  Eigen::Vector3d first, step;
};

constexpr int num_product_sums = 8;  // doubles in the widest registers

/// Adds the products f(x) f(image of x) of some cells of a row: that of the first one to sums[0], of the next one to
/// sums[1], and so on around.
/// \param f of the row.
/// \param cells [begin, end) of the row.
/// \param[in,out] sums num_product_sums of them.
using RowProducts = void (*)(const GaussianEdt& edt, const float* f, const ImageOfRow& image, GaussianEdt::Range cells,
                             double* sums);

/// \return the fastest that this processor supports; all add the same bytes.
RowProducts rowProducts();

/// D of Equation 2 for one motion of space, a reflection or a rotation: the full sum over the cells of the EDT.
/// \param image maps a position to its image, both in cells from the center of cell (0, 0, 0).
/// \param step image of the unit vector along x, as a direction.
/// \param num_threads 0 = one per core; D does not depend on it.
/// \return D in [0, 1].
template <typename Image>
double correlation(const GaussianEdt& edt, const Image& image, const Eigen::Vector3d& step, int num_threads) {
  constexpr std::size_t layers = 8;  // of cells along z, a slab
  const auto n = static_cast<std::size_t>(edt.numCells());
  std::vector<double> slabs((n + layers - 1) / layers);
  const RowProducts add = rowProducts();
  parallelBlocks(slabs.size(), num_threads, [&](std::size_t slab) {
    double sums[num_product_sums] = {};
    for (std::size_t row = slab * layers * n; row < std::min(n, (slab + 1) * layers) * n; ++row) {
      const GaussianEdt::Range filled = edt.filledRanges()[row];
      if (filled.begin == filled.end) continue;
      const Eigen::Vector3d start(0.0, static_cast<double>(row % n), static_cast<double>(row / n));
      add(edt, edt.values().data() + row * n, {image(start), step}, filled, sums);
    }
    slabs[slab] = std::accumulate(sums, sums + num_product_sums, 0.0);
  });
  return std::clamp(std::accumulate(slabs.begin(), slabs.end(), 0.0) / edt.sqNorm(), 0.0, 1.0);
}

}  // namespace pcl_symmetry
