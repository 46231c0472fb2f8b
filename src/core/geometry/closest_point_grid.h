#pragma once

#include <algorithm>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The closest point to within a cell, by one look-up. A search over many poses asks far too often for a tree.
class ClosestPointGrid {
public:
  /// \param points 3 x N, finite, N >= 1.
  /// \param num_cells cells along each side of the cube, >= 2. The cube covers 1.25 radii of the bounding ball.
  /// \throws std::invalid_argument without a point, or for less than two cells.
  explicit ClosestPointGrid(const PointsRef& points, int num_cells = 48);

  /// \return index of the point closest to the center of the cell that contains \p x; for an \p x outside the cube, of
  /// the nearest cell at its border. Cells learn of points through their neighbours; a few know one that is only nearly
  /// the closest.
  int closest(const Eigen::Vector3f& x) const {
    const Eigen::Array3f cell = ((x - origin_) / cell_size_).array().max(0.0f).min(last_);
    return nearest_[static_cast<std::size_t>(cell.z()) * num_cells_ * num_cells_ +
                    static_cast<std::size_t>(cell.y()) * num_cells_ + static_cast<std::size_t>(cell.x())];
  }

private:
  int num_cells_;
  float cell_size_;
  float last_;              // greatest coordinate inside the cube, in cells
  Eigen::Vector3f origin_;  // corner of the cube
  std::vector<int> nearest_;
};

}  // namespace pcl_symmetry
