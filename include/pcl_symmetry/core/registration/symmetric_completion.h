#pragma once

#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/geometry/reflection_plane.h"
#include "pcl_symmetry/core/scan/visibility.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

struct CompletionOptions {
  /// A reflected point this close to a point that was measured, in spacings of the points there, adds nothing; > 0.
  double overlap = 1.5;
  /// A reflected point more than this in front of what was seen lies in free space; in spacings of the points, >= 0.
  double margin = 3.0;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Which points of a partial scan show, reflected, what the scanner did not see of a symmetric object: those whose
/// reflections fall neither onto the surface that was measured nor into space that was seen to be empty.
/// \param points 3 x N, finite, input units. \param visibility what the scanner saw; null = nothing is known of it.
/// \return indices of the points, rising.
std::vector<int> completingPoints(const PointsRef& points, const ReflectionPlane& plane,
                                  const CompletionOptions& options = {}, const Visibility* visibility = nullptr);

}  // namespace pcl_symmetry
