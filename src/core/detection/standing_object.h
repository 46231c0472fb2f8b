/// Objects that stand on something: a table, the ground. Not in the paper.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// The supports that carry an object, see Visibility::withSupport(): the nearest one and those that it touches, too.
/// \param points of the object, 3 x N, finite, N >= 1.
/// \return their unit normals.
std::vector<Eigen::Vector3d> carryingNormals(const PointsRef& points, const Visibility& seen);

/// True where a plane is neither upright nor level on any of these supports; false without one.
bool slants(const ReflectionPlane& plane, const std::vector<Eigen::Vector3d>& carrying_normals);

/// Where points that stand on a ground are too far apart for a surface, as those of a LiDAR's rings, or where nothing
/// was decided: the middle plane of their upright box decides in place of what was found.
/// \param input with a visibility.
void decideByUprightBox(const PlaneInput& input, const DetectionOptions& options, Detection& found);

}  // namespace pcl_symmetry
