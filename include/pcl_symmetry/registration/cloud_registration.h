#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/frame/symmetry_frame.h"
#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/registration/pose_search.h"
#include "pcl_symmetry/core/scan/visibility.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

struct CloudRegistrationOptions {
  bool frames = true;        ///< tries the poses that bring symmetry frames together, beside evenly spread rotations
  FrameOptions frame;        ///< of these frames
  PoseSearchOptions search;  ///< of the search for poses
  int max_iterations = 30;   ///< of the refinement by PCL's point-to-plane ICP, >= 1
  /// Greatest distance of corresponding points in the refinement, input units, > 0; not set: from the data.
  std::optional<double> max_correspondence = {};
  double transformation_epsilon = 1e-8;  ///< of the refinement, as in pcl::Registration, but in radii, >= 0
  double rotation_epsilon = 0.0;         ///< of the refinement, as in pcl::Registration
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct CloudRegistration {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  /// Score of this pose. The source counts as the scan, unless only the target was seen from one side.
  PoseScore score;
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
};

/// Finds the best pose of two clouds (Section 5.1): hypotheses from symmetry frames, search, refinement by ICP, and a
/// last comparison with more points.
/// \param source,target 3 x N, finite, not all equal, input units.
/// \param source_seen,target_seen what the scanners saw of them; nothing = the cloud shows its object from all sides.
/// \param guess T_target_source, tried beside the hypotheses.
/// \param options of frames, search and refinement.
/// \return the pose of greatest merit.
/// \throws std::invalid_argument for bad options or points without extent.
CloudRegistration registerClouds(const Points& source, const std::optional<Visibility>& source_seen,
                                 const Points& target, const std::optional<Visibility>& target_seen,
                                 const Eigen::Isometry3d& guess, const CloudRegistrationOptions& options = {});

}  // namespace pcl_symmetry
