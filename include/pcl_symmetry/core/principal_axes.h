#pragma once

#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Center of mass and principal axes of a point set (PCA).
struct PrincipalAxes {
  Eigen::Vector3d center;
  Eigen::Matrix3d axes;       ///< columns, unit, by falling variance, right-handed
  Eigen::Vector3d variances;  ///< input units squared, falling
};

/// \param points 3 x N, finite, N >= 1.
PrincipalAxes principalAxes(const PointsRef& points);

/// The three planes through the center of mass across the principal axes: candidates that cost nothing.
std::vector<ReflectionPlane> principalPlanes(const PrincipalAxes& axes);

}  // namespace pcl_symmetry
