/// Objects that stand on something: a table, the ground. Not in the paper.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// The supports that carry an object, see Visibility::withSupport(): the nearest one and those that it touches, too.
/// \param points of the object, 3 x N, finite, N >= 1.
/// \return their unit normals.
std::vector<Eigen::Vector3d> carryingNormals(const PointsRef& points, const Visibility& seen);

/// True where a plane is neither upright nor level on any of these supports; false without one.
bool slants(const ReflectionPlane& plane, const std::vector<Eigen::Vector3d>& carrying_normals);

/// The middle plane of an upright box around points, along its longer side, and its evidence.
struct MiddlePlane {
  ReflectionPlane plane;
  double confidence = 0.0;                                ///< that it is a symmetry, in [0, 1]
  double num_moved = 0.0, num_met = 0.0, num_free = 0.0;  ///< points that it moves, onto the surface, into free space
  std::vector<float> point_support;                       ///< of each point: that of SymmetryPlane
  double residual = 0.0;  ///< root mean square distance of the points from the sides of the box
};

/// Symmetry of a vehicle in the rings of a spinning LiDAR (not in the paper). Rings are no surface: few points have a
/// counterpart, one or two sides are seen, and the space between two rings is unknown. Straight sides and their ends
/// are more informative.
///
/// Seen from above, the points are nearest to the sides of the upright box of least L-shape error. Its angle is tried
/// in steps of half a degree; its sides are quantiles of 1 and 99 %. The confidence is a logistic function of the share
/// of the points near a side and of the share that the plane maps into free space.
/// \param points 3 x N, finite, N >= 20, of what stands on a ground.
/// \param up normal of the ground.
/// \param viewpoint of the scanner.
/// \return nothing where the points do not resolve a box.
std::optional<MiddlePlane> middlePlaneOfBox(const PointsRef& points, const Eigen::Vector3d& up,
                                            const Eigen::Vector3d& viewpoint);

/// Where points that stand on a ground are too far apart for a surface, as those of a LiDAR's rings, or where nothing
/// was decided: the middle plane of their upright box decides in place of what was found.
/// \param points,seen as in carryingNormals().
/// \param[in,out] found planes with the support of these points.
void decideByUprightBox(const PointsRef& points, const Visibility& seen, const DetectionOptions& options,
                        Detection& found);

}  // namespace pcl_symmetry
