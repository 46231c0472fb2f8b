#pragma once

#include <optional>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/plane_types.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/visibility.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Options of the completion of a scan by its reflection.
struct CompletionOptions {
  /// Distance from a measured point within which reflected points add nothing, local spacings of the points, > 0.
  double overlap = 1.5;
  /// Distance in front of the visible surface beyond which reflected points lie in free space, local spacings of the
  /// points, >= 0.
  double margin = 3.0;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The plane through an axis of revolution that reflects the visible side onto the hidden one: it is perpendicular to
/// the view.
/// \param viewpoint where the scanner stood; a viewpoint on the axis gives no direction, and any plane through the axis
/// is returned.
ReflectionPlane planeAcrossView(const Line3d& axis, const Eigen::Vector3d& viewpoint);

/// The same through the center of symmetry that was found, or else through the best axis; nothing if there is neither.
std::optional<ReflectionPlane> planeAcrossView(const Detection& found, const Eigen::Vector3d& viewpoint);

/// The points of a partial scan whose reflections show unseen parts of a symmetric object: they fall neither onto the
/// measured surface nor into free space.
/// \param points 3 x N, finite, input units.
/// \param plane a symmetry plane of the object, input frame.
/// \param options tolerances in spacings of the points.
/// \param visibility what the scanner saw, input frame; null = nothing is known about it.
/// \return indices of these points, ascending.
/// \throws std::invalid_argument for bad options.
std::vector<int> completingPoints(const PointsRef& points, const ReflectionPlane& plane,
                                  const CompletionOptions& options = {}, const Visibility* visibility = nullptr);

}  // namespace pcl_symmetry
