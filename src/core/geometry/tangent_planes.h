#pragma once

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Planes fitted to the neighbours of some points, worked out side by side.
struct TangentPlanes {
  static constexpr int kMost = 64;  ///< points. chosen: their sums stay in the first cache

  float normal[3][kMost];      ///< unit; along z where the neighbours show no plane
  float offset_sum[3][kMost];  ///< sum of the neighbours' offsets from the point
  float roughness[kMost];      ///< root mean square distance of the neighbours from the plane

  /// \param points 3 x N.
  /// \param places 3 x M, at most kMost, side by side.
  /// \param neighbours \p count indices of points for each place.
  void fit(const Points& points, const PointsRef& places, const int* neighbours, int count);
};

}  // namespace pcl_symmetry
