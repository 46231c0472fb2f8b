#pragma once

#include <vector>

#include "pcl_symmetry/core/plane_detection.h"

namespace pcl_symmetry {

/// The supports that carry an object, see Visibility::withSupport(): the nearest one and those that it touches, too.
/// \param points of the object, 3 x N, finite, N >= 1.
/// \return their unit normals.
std::vector<Eigen::Vector3d> carryingNormals(const PointsRef& points, const Visibility& seen);

/// True where a plane is neither upright nor level on any of these supports; false without one.
bool slants(const ReflectionPlane& plane, const std::vector<Eigen::Vector3d>& carrying_normals);

/// Lowers the confidence of planes that slant (not in the paper): what stands on a table was made to stand there, or
/// lies on one of its sides, and then its planes are upright or level, but for few. A plane that maps noise or a part
/// of an object onto itself slants as it likes.
/// \param planes of one detection, see Detection::planes: symmetries that become doubtful go behind the others.
/// \param options of that detection.
void doubtSlantedPlanes(std::vector<SymmetryPlane>& planes, const PointsRef& points, const Visibility& seen,
                        const DetectionOptions& options);

}  // namespace pcl_symmetry
