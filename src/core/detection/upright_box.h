#pragma once

#include <Eigen/Core>
#include <optional>

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Symmetry of a vehicle in the rings of a spinning LiDAR (not in the paper). Rings are no surface: few points have a
/// counterpart, one or two sides are seen, and the space between two rings is unknown. Straight sides and their ends
/// are more informative.
///
/// Seen from above, the points are nearest to the sides of the upright box of least L-shape error. Its angle is tried
/// in steps of half a degree; its sides are quantiles of 1 and 99 %. The middle plane along its longer side is the
/// candidate. Its confidence is a logistic function of the share of the points near a side and of the share that it
/// maps into free space.
/// \param points 3 x N, finite, N >= 20, of what stands on a ground.
/// \param up normal of the ground.
/// \param viewpoint of the scanner.
/// \return with confidence, share, support, seen and the support of each point; nothing where the points do not resolve
/// a box.
std::optional<SymmetryPlane> middlePlaneOfBox(const PointsRef& points, const Eigen::Vector3d& up,
                                              const Eigen::Vector3d& viewpoint);

/// Where points that stand on a ground are too far apart for a surface, as those of a LiDAR's rings: the middle plane
/// of their upright box decides in place of what was found.
void decideByUprightBox(const PointsRef& points, const Visibility& seen, const DetectionOptions& options,
                        Detection& found);

}  // namespace pcl_symmetry
