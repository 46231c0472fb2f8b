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
  /// the nearest cell at its border. A few cells have a point that is only nearly the closest.
  int closest(const Eigen::Vector3f& x) const {
    const Eigen::Array3i cell = cellOf(x);
    return nearest_[indexOf(cell.x(), cell.y(), cell.z())];
  }

private:
  /// The first cell for coordinates that are no numbers.
  Eigen::Array3i cellOf(const Eigen::Vector3f& x) const {
    const auto cell = [&](int k) {
      return static_cast<int>(std::min(last_, std::max(0.0f, (x[k] - origin_[k]) / cell_size_)));
    };
    return {cell(0), cell(1), cell(2)};
  }
  std::size_t indexOf(int x, int y, int z) const { return (static_cast<std::size_t>(z) * n_ + y) * n_ + x; }

  int n_;  // cells along each side
  float cell_size_;
  float last_;                // greatest coordinate inside the cube, in cells
  Eigen::Vector3f origin_;    // corner of the cube
  std::vector<int> nearest_;  // of each cell, x fastest
};

}  // namespace pcl_symmetry
