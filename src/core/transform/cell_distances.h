#pragma once

#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Squared distances of the cells of a cube from the nearest of some points, exact up to a reach (Section 4.1).
/// \param points 3 x N, in cells from the center of cell (0, 0, 0).
/// \param num_cells along each side of the cube.
/// \param reach beyond which distances do not matter, cells, > 0.
/// \param num_threads 0 = one per core.
/// \return num_cells^3 values, x fastest: at most reach^2.
std::vector<float> sqCellDistances(const Points& points, int num_cells, float reach, int num_threads);

}  // namespace pcl_symmetry
