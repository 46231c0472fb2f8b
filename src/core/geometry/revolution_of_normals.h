#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Axis and center that the normals of a surface point to (Pottmann and Wallner, Computational Line Geometry, 2001).
///
/// Beyond the paper: the normals of a body of revolution all meet its axis, and those of a sphere its center. Few of
/// them are enough, so that a body seen from one side has an axis where hardly two of its planes are maxima of the
/// transform.

/// The line that most of the normals meet or are parallel to. Points are weighted by how well they fit, so that a
/// handle or a base does not move it.
/// \param points 3 x N, finite, about the unit ball.
/// \param normals 3 x N, unit, of any sign.
/// \param samples indices of points, at least one.
/// \return the best line, whether the points lie on a body of revolution or not.
Line3d axisOfNormals(const Points& points, const Points& normals, const std::vector<int>& samples);

/// The point that most of the normals meet.
/// \param points,normals,samples as in axisOfNormals().
Eigen::Vector3d centerOfNormals(const Points& points, const Points& normals, const std::vector<int>& samples);

}  // namespace pcl_symmetry
