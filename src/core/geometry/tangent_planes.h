#pragma once

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Planes fitted to the neighbors of some points, worked out side by side.
struct TangentPlanes {
  static constexpr int most = 64;  // points: their sums stay in the first cache

  float normal[3][most];      ///< unit; along z where the neighbors show no plane
  float offset_sum[3][most];  ///< sum of the neighbors' offsets from the point
  float roughness[most];      ///< root mean square distance of the neighbors from the plane

  /// \param points 3 x N.
  /// \param positions 3 x M, at most most, side by side.
  /// \param neighbors \p count indices of points for each position.
  void fit(const Points& points, const PointsRef& positions, const int* neighbors, int count);
};

}  // namespace pcl_symmetry
