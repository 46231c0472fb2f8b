#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// One normal for each occupied cell of a coarse grid. It depends neither on the density of the points nor on noise
/// below the size of a cell.
struct CellNormals {
  Eigen::Matrix3Xf normals;         ///< 3 x C, unit, of arbitrary sign
  Eigen::VectorXf flatness;         ///< C, in [0, 1]: 1 for a plane, 0 where the points show no surface
  std::vector<int> cell_of_points;  ///< N, column of `normals` for each point
};

/// Fits a plane to the points of each occupied cell and its 26 neighbors.
/// \param points 3 x N, finite.
/// \param origin corner of the cube of cells. The few points outside it are assigned to the cells at its sides.
/// \param cell_size input units, > 0.
/// \param num_cells cells along each side of the cube.
CellNormals cellNormals(const PointsRef& points, const Eigen::Vector3d& origin, double cell_size, int num_cells);

}  // namespace pcl_symmetry
