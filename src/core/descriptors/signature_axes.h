#pragma once

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// Points about the center of their bounding ball, in its radii, so that no unit is too small or too large for squares.
/// \throws std::invalid_argument for points without extent or a coordinate that is not finite.
Points inRadii(const PointsRef& points);

/// Points in axes of their symmetry, about the point half-way between their center of mass and the middle of their
/// extent. \param axes unit, in columns.
Points aboutMiddle(const Points& points, const Eigen::Matrix3d& axes);

/// Points stretched to equal root mean squares along the axes; flat shapes less than that.
Points stretched(const Points& points);

}  // namespace pcl_symmetry
