#pragma once

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Places and sizes that make the descriptors of a shape independent of its unit and position (Section 5.2).

/// Points about the center of their bounding ball, in units of its radius: squares neither overflow nor underflow.
/// \throws std::invalid_argument for points without extent or a coordinate that is not finite.
Points inRadii(const PointsRef& points);

/// Points in the axes of their symmetry, about the point half-way between their center of mass and the middle of their
/// extent.
/// \param points 3 x N, N >= 1.
/// \param axes unit vectors in columns.
Points aboutMiddle(const Points& points, const Eigen::Matrix3d& axes);

/// Points divided by their root mean squares along the axes. A flat shape is stretched no further than if its smallest
/// root mean square were 5 % of its greatest.
Points stretched(const Points& points);

}  // namespace pcl_symmetry
