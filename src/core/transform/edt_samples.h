#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

/// Draws points with probability f: a cell by its value of f, then a uniform place in the cell.
///
/// Stratified: one point falls in each of num_samples equal shares of the sum of f along a space-filling curve, so that
/// the points are spread evenly over the surface.
/// \param num_samples >= 1.
/// \param num_threads 0 = one per core; the points do not depend on it.
/// \return 3 x num_samples, in cells from the center of cell (0, 0, 0).
Eigen::Matrix3Xf drawPoints(const GaussianEdt& edt, int num_samples, std::uint64_t seed, int num_threads);

}  // namespace pcl_symmetry
