/// Planes that share a line or a point, as the symmetries of bodies of revolution and of spheres do.
#pragma once

#include <vector>

#include "evaluate/shared/plane_difference.h"

namespace pcl_symmetry::apps {

/// Planes through a line at angles that are spread evenly and repeat those of no polygon.
std::vector<ReflectionPlane> planesThrough(const Line3d& line, int count);

/// Planes through a point, normals on a Fibonacci half sphere.
std::vector<ReflectionPlane> planesThrough(const Eigen::Vector3d& point, int count);

/// The line closest to lying in all planes, of which two must not be parallel.
/// \param start says where along it its
/// origin is.
Line3d commonLine(const std::vector<ReflectionPlane>& planes, const Line3d& start);

/// The point closest to lying on all lines, of which two must not be parallel.
Eigen::Vector3d commonPoint(const std::vector<Line3d>& lines);

}  // namespace pcl_symmetry::apps
