#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// A plane and its small motions: two tilts about a pivot, and a shift along the normal.
struct PlaneChart {
  Eigen::Vector3d n, u, v;  ///< normal, and directions across it
  Eigen::Vector3d pivot;
  double extent;  ///< unit of the shift
  double offset;  ///< of the plane from the pivot, along n

  PlaneChart(const ReflectionPlane& plane, const Eigen::Vector3d& about, double unit_of_shift = 1.0);

  /// How fast the reflection of a point moves along a direction, by each parameter of a step.
  /// \param from_pivot of the point.
  /// \param height of the point above the plane.
  Eigen::Vector3d slope(const Eigen::Vector3d& from_pivot, double height, const Eigen::Vector3d& along) const {
    const double along_n = along.dot(n);
    return {-2.0 * (u.dot(from_pivot) * along_n + height * along.dot(u)),
            -2.0 * (v.dot(from_pivot) * along_n + height * along.dot(v)), 2.0 * extent * along_n};
  }

  /// \param step tangents of the tilts of the normal toward u and v, then the shift in extents.
  ReflectionPlane moved(const Eigen::Vector3d& step) const;
};

/// How firmly the matched samples hold a plane. A match is worth what it excludes: a sheet that is mirrored in itself
/// matches under any tilt of the plane about its normal, a ball under all tilts.
/// \param points 3 x N, in the unit ball, the reflections of the samples.
/// \param normals 3 x N, unit, of the surface at their matches.
/// \param matched N values.
/// \param plane in the frame of the points.
/// \return mean product of the changes of a match's distance per two tilts (radians) and the offset, in this order;
/// symmetric, eigenvalues in [0, 12]; 0 where nothing matches.
Eigen::Matrix3d motionStiffness(const Points& points, const Points& normals, const std::vector<char>& matched,
                                const ReflectionPlane& plane);

/// How firmly the matches fix the offset of a plane: those of a tube fix it only at its ends.
/// \param stiffness of motionStiffness().
/// \return mean square of the change of a match's distance per change of the offset, after the best tilt, in [0, 4].
double offsetStiffness(const Eigen::Matrix3d& stiffness);

/// How firmly a plane is held but for one motion that it may be free to make, as planes through an axis are.
/// \param stiffness of motionStiffness().
/// \return the second of its three eigenvalues, in [0, 6].
double secondStiffness(const Eigen::Matrix3d& stiffness);

}  // namespace pcl_symmetry
