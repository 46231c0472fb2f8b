#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Finds out from the points of a scene whether they were measured from a viewpoint. Unlike that of one object, a scene
/// may surround the viewpoint.
/// \param points 3 x N, finite.
/// \param viewpoint in the frame of the points.
/// \param max_pixels as in Visibility::ofScene().
/// \return the space seen from the viewpoint; nothing if the points were not measured from there.
std::optional<Visibility> sceneSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        std::size_t max_pixels);

/// What a single view may show at most, shares of the points.
struct SingleViewLimits {
  double max_hidden;   ///< that lie well behind others
  double max_layered;  ///< layeredShare()
};

/// spaceSeenFrom() of visibility.h with other limits.
std::optional<Visibility> spaceSeenFrom(const PointsRef& points, const Eigen::Vector3d& viewpoint,
                                        const SingleViewLimits& limits);

/// Share of the points that form layers as seen from a viewpoint.
///
/// A point is layered if the next point in the picture is much farther away or much nearer, and the roughness of the
/// surface does not explain it. A scan has one layer except at its silhouettes (0.1 of the points, up to 0.2 with
/// noise); an object that is known from all sides has two or more.
/// \param points 3 x N, finite.
/// \param viewpoint in the frame of the points.
/// \return a value in [0, 1]; 0 for fewer than two points.
double layeredShare(const PointsRef& points, const Eigen::Vector3d& viewpoint);

/// How much of a cloud the picture cut off.
/// \param points 3 x N, finite, N >= 1, seen within 75 degrees of one direction.
/// \param margin where the picture is looked up beyond the outermost points, share of their distance from the middle.
/// \return share of the directions of the outline, seen from the viewpoint, in which the picture ends beside the cloud.
double cutShare(const PointsRef& points, const Visibility& seen, double margin);

/// Whether a scanner saw that nothing is at a point, nor beside it.
/// \param margin least depth of the point before what was seen, units of the points.
/// \param rim how far beside the point nothing must have been seen either; 0 = only at the point.
bool isSeenEmpty(const Visibility& seen, const Eigen::Vector3d& x, double margin, double rim);

}  // namespace pcl_symmetry
