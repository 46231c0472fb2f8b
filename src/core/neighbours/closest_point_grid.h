#pragma once

#include <algorithm>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// Which point is closest, to within a cell, in one look-up: what a search over many poses asks far too often for a
/// tree.
class ClosestPointGrid {
public:
  /// \param points 3 x N, finite, N >= 1. \param num_cells along each side, >= 2; the cube covers 1.25 radii of the
  /// bounding ball.
  explicit ClosestPointGrid(const PointsRef& points, int num_cells = 48);

  /// Index of the point closest to the center of the cell that holds \p x, or of the cell at the border closest to it.
  /// Cells know of points through their neighbours, so that a few hold one that is only nearly the closest.
  int closest(const Eigen::Vector3f& x) const {
    const Eigen::Array3f cell = ((x - origin_) / cell_size_).array().max(0.0f).min(last_);
    return nearest_[static_cast<std::size_t>(cell.z()) * num_cells_ * num_cells_ +
                    static_cast<std::size_t>(cell.y()) * num_cells_ + static_cast<std::size_t>(cell.x())];
  }

private:
  int num_cells_;
  float cell_size_;
  float last_;
  Eigen::Vector3f origin_;  ///< corner of the cube
  std::vector<int> nearest_;
};

}  // namespace pcl_symmetry
