#pragma once

#include <Eigen/Core>
#include <optional>

#include "pcl_symmetry/core/scan/visibility.h"

namespace pcl_symmetry {

/// Share of the points that form layers as seen from a viewpoint: next to them in the picture is a point much farther
/// away or much nearer, although the surface is not so rough. A scan has one layer but for its silhouettes (0.1 of the
/// points, 0.2 of some in noise), an object that is known from all sides has two and more.
/// \param points 3 x N, finite. \return a value in [0, 1]; 0 for fewer than two points.
double layeredShare(const PointsRef& points, const Eigen::Vector3d& viewpoint);

/// Finds out whether points were measured from a viewpoint: they lie in front of it, hardly any of them behind others,
/// in one layer. An open surface that can be seen whole from there passes too.
/// \param points 3 x N, finite, N >= 1. \return the space seen, or nothing.
std::optional<Visibility> recognizeViewpoint(const PointsRef& points, const Eigen::Vector3d& viewpoint);

}  // namespace pcl_symmetry
