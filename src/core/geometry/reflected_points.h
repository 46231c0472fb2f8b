#pragma once

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// \return 3 x N, the points reflected across a plane, in their order.
inline Points reflectedPoints(const PointsRef& points, const ReflectionPlane& plane) {
  Points reflected(3, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    reflected.col(i) = plane.reflect(points.col(i).cast<double>()).cast<float>();
  return reflected;
}

}  // namespace pcl_symmetry
