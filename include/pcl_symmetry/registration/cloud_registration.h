#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/registration/pose_search.h"
#include "pcl_symmetry/core/frame/symmetry_frame.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

struct CloudRegistrationOptions {
  bool frames = true;  ///< tries the poses that bring symmetry frames together; or else evenly spread rotations alone
  FrameOptions frame;  ///< of these frames
  PoseSearchOptions search;
  int max_iterations = 30;                        ///< of the refinement by PCL's point-to-plane ICP, >= 1
  std::optional<double> max_correspondence = {};  ///< of the refinement, input units, > 0; not set: from the data
  double transformation_epsilon = 1e-8;           ///< of the refinement, as pcl::Registration has it, in radii, >= 0
  double rotation_epsilon = 0.0;                  ///< of the refinement, as pcl::Registration has it
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

struct CloudRegistration {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  PoseScore score;
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
};

/// The best pose of two clouds: frames by symmetry, search, refinement, and a last look with all points.
/// \param source,target 3 x N, finite, not all equal. \param source_seen,target_seen what scanners saw of them.
/// \param guess tried besides.
/// \throws std::invalid_argument for bad options or points without extent.
CloudRegistration registerClouds(const Points& source, const std::optional<Visibility>& source_seen,
                                 const Points& target, const std::optional<Visibility>& target_seen,
                                 const Eigen::Isometry3d& guess, const CloudRegistrationOptions& options = {});

/// Between the input frames of two clouds and those of the search for a pose, which are about their centers and in
/// units of one scale.
struct SearchFrames {
  Eigen::Vector3d source_center, target_center;
  double scale;

  Eigen::Isometry3d toSearch(const Eigen::Isometry3d& T_target_source) const;
  Eigen::Isometry3d toInput(const Eigen::Isometry3d& T_target_source) const;
};

/// Refinement and last look of registerClouds(), the best of some poses.
/// \param scan,model in search frames. \param poses of searchPoses(), best first. \param options those of the
/// refinement count, max_correspondence in units of the search. \return T_model_scan in search frames.
RankedPose refinePoses(const PosedSurface& scan, const PosedSurface& model, const std::vector<RankedPose>& poses,
                       const CloudRegistrationOptions& options);

}  // namespace pcl_symmetry
