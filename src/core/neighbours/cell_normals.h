#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// One normal for each cell of a coarse grid that the surface passes, so that neither the density of the points nor
/// noise below the size of a cell matters.
struct CellNormals {
  Eigen::Matrix3Xf normals;         ///< 3 x C, unit, of any sign
  Eigen::VectorXf flatness;         ///< C, in [0, 1]: 0 where the points show no surface
  std::vector<int> cell_of_points;  ///< N, columns of the former
};

/// \param points 3 x N, finite. \param origin corner of a cube that holds them, but for a few that count with the cells
/// next to its sides. \param num_cells along each of its sides.
CellNormals cellNormals(const PointsRef& points, const Eigen::Vector3d& origin, double cell_size, int num_cells);

}  // namespace pcl_symmetry
