#pragma once

#include <Eigen/Geometry>

#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// A plane and its small motions: two tilts about a pivot, and a translation along the normal.
struct PlaneChart {
  Eigen::Vector3d n, u, v;  ///< normal, and two directions perpendicular to it
  Eigen::Vector3d pivot;
  double extent;  ///< unit of the translation
  double offset;  ///< offset of the plane from the pivot, along n

  PlaneChart(const ReflectionPlane& plane, const Eigen::Vector3d& about, double unit_of_shift = 1.0)
      : n(plane.normal()),
        u(n.unitOrthogonal()),
        v(n.cross(u)),
        pivot(about),
        extent(unit_of_shift),
        offset(plane.offset() - n.dot(pivot)) {}

  /// How fast the reflection of a point moves along a direction with each parameter of a step.
  /// \param from_pivot position of the point relative to the pivot.
  /// \param height of the point above the plane.
  Eigen::Vector3d slope(const Eigen::Vector3d& from_pivot, double height, const Eigen::Vector3d& along) const {
    const double along_n = along.dot(n);
    return {-2.0 * (u.dot(from_pivot) * along_n + height * along.dot(u)),
            -2.0 * (v.dot(from_pivot) * along_n + height * along.dot(v)), 2.0 * extent * along_n};
  }

  /// \param step tangents of the tilts of the normal toward u and v, then the translation in extents.
  ReflectionPlane moved(const Eigen::Vector3d& step) const {
    const Eigen::Vector3d normal = (n + step[0] * u + step[1] * v).normalized();
    return ReflectionPlane(normal, normal.dot(pivot) + offset + step[2] * extent);
  }
};

}  // namespace pcl_symmetry
