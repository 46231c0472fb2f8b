/// Objects that stand on something: a table, the ground. Not in the paper.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// The supports that carry an object, see Visibility::withSupport(): the nearest one and others that the object
/// touches.
/// \param points points of the object, 3 x N, finite, N >= 1.
/// \return their unit normals.
std::vector<Eigen::Vector3d> supportNormals(const PointsRef& points, const Visibility& seen);

/// Whether a plane is neither upright nor level on any of these supports; false without supports.
bool isSlanted(const ReflectionPlane& plane, const std::vector<Eigen::Vector3d>& support_normals);

/// Symmetry of a vehicle in the rings of a spinning LiDAR. Rings are not a surface: few points have a counterpart, one
/// or two sides are visible, and the space between two rings is unknown. Straight sides and their ends are more
/// informative. Not in the paper.
///
/// Seen from above, the points are nearest to the sides of the upright box of least L-shape error. Its angle is tried
/// in steps of half a degree; its sides are quantiles of 1 and 99 %. The confidence is a logistic function of the share
/// of the points near a side and of the share that the plane maps into free space.
/// \param points 3 x N, finite, N >= 20, of an object on a ground.
/// \param up normal of the ground.
/// \param viewpoint position of the scanner.
/// \return the middle plane of the box, along its longer side, without a kind; its residual is the distance (rms) of
/// the points from the sides. Nothing if the points do not resolve a box.
std::optional<SymmetryPlane> middlePlaneOfBox(const PointsRef& points, const Eigen::Vector3d& up,
                                              const Eigen::Vector3d& viewpoint);

/// Decides by the middle plane of the upright box around points on a ground, if they are too sparse for a surface, such
/// as the rings of a LiDAR, or if no symmetry was found.
/// \param points,seen as in supportNormals().
/// \param[in,out] found result for these points; its planes have their support.
void decideByUprightBox(const PointsRef& points, const Visibility& seen, const DetectionOptions& options,
                        Detection& found);

}  // namespace pcl_symmetry
