/// How far planes, axes and points are apart: one angle and one offset, measured near the shape.
#pragma once

#include <Eigen/Geometry>

#include "pcl_symmetry/core/geometry/reflection_plane.h"
#include "pcl_symmetry/core/transform_axes/axial_transform.h"

namespace pcl_symmetry::apps {

struct Difference {
  double angle = 0.0;   ///< radians, in [0, pi/2]
  double offset = 0.0;  ///< input units, >= 0

  bool within(double max_angle, double max_offset) const { return angle <= max_angle && offset <= max_offset; }
};

/// Angle of the normals; distance of the planes at \p center.
Difference difference(const ReflectionPlane& a, const ReflectionPlane& b, const Eigen::Vector3d& center);

/// What keeps the line from lying in the plane: its angle to the plane, and the distance from the plane of its point
/// closest to \p center.
Difference difference(const ReflectionPlane& plane, const Line3d& line, const Eigen::Vector3d& center);

/// Angle of the directions; distance from line a of the point of b that is closest to \p center.
Difference difference(const Line3d& a, const Line3d& b, const Eigen::Vector3d& center);

}  // namespace pcl_symmetry::apps
