#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/registration/posed_surface.h"

namespace pcl_symmetry {

/// A point of a surface that nothing of the surface hides from a scanner.
struct VisiblePoint {
  Eigen::Index index;                ///< in the order of the surface
  Eigen::Vector3d position, normal;  ///< in the frame of the scan; the normal of any sign
  double cosine;                     ///< between normal and ray, > 0: the area that the scanner sees of it
  /// Height above what was measured on its ray, along the normal: positive in free space, infinite where the ray met
  /// nothing, and minus infinity where no ray passed.
  double height;
};

/// \param scan with what its scanner saw.
/// \param num_points of the surface that are looked at.
/// \param is_strict also points that are hidden a little beside their rays are left out: pictures that are made of points
/// have gaps, through which a point at the back is seen.
std::vector<VisiblePoint> visiblePoints(const PosedSurface& surface, const PosedSurface& scan,
                                        const Eigen::Isometry3d& T_scan_surface, int num_points, bool is_strict);

}  // namespace pcl_symmetry
