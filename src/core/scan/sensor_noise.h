#pragma once

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// The picture of a depth camera, row by row.
struct DepthImage;

/// Errors of the inverse depths of a camera, from its picture alone.
///
/// inverseDepthError() sees what differs between neighbors. Pixels share most of their error with their neighbors, as
/// stereo and structured light match windows of pixels.
/// \return standard deviation of the whole error, units of the inverse depths.
double sensorError(const DepthImage& image);

/// The least tolerance that a depth camera resolves: the reflection of a point and the surface that it is compared with
/// both have the error of a depth, and 97 % of the points of a true symmetry are to be within it.
/// \param points 3 x N, N >= 1.
/// \param seen in the same frame.
/// \return units of the points; 0 where the errors are not known.
double resolvedTolerance(const PointsRef& points, const Visibility& seen);

}  // namespace pcl_symmetry
