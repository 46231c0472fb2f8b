#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/base/parallel.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// D of Equation 2 for one motion of space, a reflection or a rotation: the full sum over the cells of the EDT.
/// \param image maps a position to its image, both in cells from the center of cell (0, 0, 0).
/// \param step image of the unit vector along x, as a direction.
/// \return D in [0, 1].
template <typename Image>
double correlation(const GaussianEdt& edt, const Image& image, const Eigen::Vector3d& step, int num_threads) {
  constexpr std::size_t layers = 8;    // of cells along z, a slab
  constexpr std::size_t num_sums = 8;  // of a slab, over cells in turn: rounding errors grow less than in one
  const auto n = static_cast<std::size_t>(edt.numCells());
  std::vector<double> slabs((n + layers - 1) / layers);
  parallelBlocks(slabs.size(), num_threads, [&](std::size_t slab) {
    double sums[num_sums] = {};
    for (std::size_t row = slab * layers * n; row < std::min(n, (slab + 1) * layers) * n; ++row) {
      const GaussianEdt::Range filled = edt.filledRanges()[row];
      if (filled.begin == filled.end) continue;
      const float* const f = edt.values().data() + row * n;
      const Eigen::Vector3d first =
          image(Eigen::Vector3d(0.0, static_cast<double>(row % n), static_cast<double>(row / n)));
      for (int x = filled.begin; x < filled.end; ++x)
        if (f[x] > 0.0f) sums[(x - filled.begin) % num_sums] += f[x] * edt.atCell(first + x * step);
    }
    slabs[slab] = std::accumulate(sums, sums + num_sums, 0.0);
  });
  return std::clamp(std::accumulate(slabs.begin(), slabs.end(), 0.0) / edt.sqNorm(), 0.0, 1.0);
}

/// The same for a reflection across a plane, input frame.
inline double correlation(const GaussianEdt& edt, const ReflectionPlane& plane, int num_threads) {
  const ReflectionPlane cells(plane.normal(), plane.signedDistance(edt.origin()) / -edt.cellSize());
  const Eigen::Vector3d step = Eigen::Vector3d::UnitX() - 2.0 * plane.normal().x() * plane.normal();
  return correlation(
      edt, [&](const Eigen::Vector3d& x) { return cells.reflect(x); }, step, num_threads);
}

}  // namespace pcl_symmetry
