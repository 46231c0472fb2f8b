#pragma once

#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// The supports that carry an object, see Visibility::withSupport(): the nearest one and those that it touches, too.
/// \param points of the object, 3 x N, finite, N >= 1.
/// \return their unit normals.
std::vector<Eigen::Vector3d> carryingNormals(const PointsRef& points, const Visibility& seen);

/// True where a plane is neither upright nor level on any of these supports; false without one.
bool slants(const ReflectionPlane& plane, const std::vector<Eigen::Vector3d>& carrying_normals);

}  // namespace pcl_symmetry
