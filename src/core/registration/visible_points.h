#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/registration/posed_surface.h"

namespace pcl_symmetry {

/// A point of a surface that the surface itself does not hide from a scanner.
struct VisiblePoint {
  Eigen::Index index;                ///< index in the order of the surface
  Eigen::Vector3d position, normal;  ///< frame of the scan; the normal has any sign
  double cosine;                     ///< cosine between normal and ray, > 0: its visible area
  /// Height above the measured surface on its ray, along the normal: positive in free space, infinity if the ray met no
  /// surface, and minus infinity if no ray passed.
  double height;
};

/// \param scan a scan, with what its scanner saw.
/// \param num_points number of points of the surface that are examined.
/// \param is_strict also leaves out points that are hidden slightly beside their rays: images made from points have
/// gaps, through which points at the back are visible.
std::vector<VisiblePoint> visiblePoints(const PosedSurface& surface, const PosedSurface& scan,
                                        const Eigen::Isometry3d& T_scan_surface, int num_points, bool is_strict);

}  // namespace pcl_symmetry
