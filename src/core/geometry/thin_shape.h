#pragma once

#include "core/geometry/principal_axes.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// What is left of a shape at a tolerance: reflections along its thin directions move nothing and say nothing.
enum class Thinness {
  Solid,
  Sheet,  ///< 97 % of the points lie within the tolerance of planes of one plane
  Line    ///< 97 % of the points lie within the tolerance of lines of one line
};

/// \param points 3 x N, finite, N >= 1.
/// \param axes of the points.
/// \param plane_tolerance,line_tolerance how far points may lie from a plane and from a line, units of the points, > 0.
Thinness thinnessOf(const PointsRef& points, const PrincipalAxes& axes, double plane_tolerance, double line_tolerance);

}  // namespace pcl_symmetry
