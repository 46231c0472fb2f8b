#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/registration/pose_scoring.h"
#include "pcl_symmetry/symmetry_registration.h"

namespace pcl_symmetry {

/// The frames of a search for poses: about the center of each cloud, in units of one scale.
struct SearchFrames {
  Eigen::Vector3d source_center, target_center;  ///< input frames
  double scale;                                  ///< input units, > 0

  /// A pose T_target_source between input frames as a pose between search frames.
  Eigen::Isometry3d toSearch(const Eigen::Isometry3d& T_target_source) const;
  /// A pose T_target_source between search frames as a pose between input frames.
  Eigen::Isometry3d toInput(const Eigen::Isometry3d& T_target_source) const;
};

/// \param max_correspondence in units of the search; not set: from the accuracy of the surfaces.
/// \return distance in which refinePoses() looks for corresponding points, units of the search.
double refinementReach(const PosedSurface& scan, const PosedSurface& model, std::optional<double> max_correspondence);

/// \return distance in which closestPose() looks for them: that in which samples of one surface meet.
double closestReach(const PosedSurface& scan, const PosedSurface& model, std::optional<double> max_correspondence);

/// The final comparison of two surfaces in a pose, with more points than the search.
PoseScore lastScore(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan);

/// Poses and their refinements by PCL's point-to-plane ICP, of each the one of greater merit.
/// \param scan,model in search frames.
/// \param poses from searchPoses(), best first, at least one. Poses far behind the best are left out.
/// \param options of the refinement; max_correspondence in units of the search.
/// \return distinct ones, at least one, best first; T_model_scan between search frames.
std::vector<RankedPose> refinePoses(const PosedSurface& scan, const PosedSurface& model,
                                    const std::vector<RankedPose>& poses, const CloudRegistrationOptions& options);

/// A pose from refinePoses(), refined once more with pairs as close as the points allow. Parts that only one of two
/// scans shows pair with the border of the other one, and pull as far as ICP reaches.
RankedPose closestPose(const PosedSurface& scan, const PosedSurface& model, const RankedPose& pose,
                       const CloudRegistrationOptions& options);

}  // namespace pcl_symmetry
