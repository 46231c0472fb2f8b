#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/geometry/reflection_plane.h"

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

/// The pose of the plane that points lie in: takes (x, y, 0) to their frame.
/// \param points 3 x N, finite, N >= 1. \return axes kept and z their own where all z are equal (to a millionth of the
/// extent); else the center of mass and the principal axes.
Eigen::Isometry3d sheetPose(const PointsRef& points);

}  // namespace pcl_symmetry
