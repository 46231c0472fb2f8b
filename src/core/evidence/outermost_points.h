#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Points that are asked again and again which of them are the last ones along a direction.
///
/// The points are kept by cells. Cells whose boxes end before what was found are passed over, so that most questions
/// look at a few cells alone.
class OutermostPoints {
public:
  /// \param points 3 x N, finite, N > 0; copied.
  explicit OutermostPoints(const Points& points);

  Eigen::Index size() const { return static_cast<Eigen::Index>(index_of_.size()); }
  const Eigen::Vector3f& mean() const { return mean_; }

  /// The point that is farthest along a direction; of several the first one.
  Eigen::Vector3f last(const Eigen::Vector3f& direction) const;

  /// Calls visit(index of the point, its distance along the direction) for the points of which this distance is at
  /// least \p from.
  template <typename Visit>
  void visitFrom(const Eigen::Vector3f& direction, float from, const Visit& visit) const {
    for (const Cell& cell : cells_) {
      if (cell.bound(direction) < from) continue;
      for (std::size_t i = cell.begin; i < cell.end; ++i)
        if (const float value = along(direction, i); value >= from) visit(index_of_[i], value);
    }
  }

private:
  struct Cell {
    Eigen::Vector3f least, most;  ///< corners of the box of its points
    std::size_t begin, end;       ///< places of its points

    /// No point of the cell is farther along the direction. As along() is computed, so that rounding keeps the order.
    float bound(const Eigen::Vector3f& direction) const {
      const auto corner = [&](int k) { return direction[k] > 0.0f ? most[k] : least[k]; };
      return direction.x() * corner(0) + direction.y() * corner(1) + direction.z() * corner(2);
    }
  };

  float along(const Eigen::Vector3f& direction, std::size_t i) const {
    return direction.x() * coordinates_[0][i] + direction.y() * coordinates_[1][i] + direction.z() * coordinates_[2][i];
  }

  std::vector<Cell> cells_;
  std::array<std::vector<float>, 3> coordinates_;  ///< of the points, cell after cell
  std::vector<Eigen::Index> index_of_;             ///< of these points, among those that were given
  Eigen::Vector3f mean_;
};

}  // namespace pcl_symmetry
