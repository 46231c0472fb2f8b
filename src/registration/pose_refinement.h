#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "core/registration/pose_scoring.h"
#include "pcl_symmetry/symmetry_registration.h"

namespace pcl_symmetry {

/// The frames of a search for poses: about the center of each cloud, in units of a common scale.
struct SearchFrames {
  Eigen::Vector3d source_center, target_center;  ///< input frames
  double scale;                                  ///< input units, > 0

  /// A pose T_target_source between input frames as a pose between search frames.
  Eigen::Isometry3d toSearch(const Eigen::Isometry3d& T_target_source) const;
  /// A pose T_target_source between search frames as a pose between input frames.
  Eigen::Isometry3d toInput(const Eigen::Isometry3d& T_target_source) const;
};

/// \param max_correspondence units of the search; not set: from the accuracy of the surfaces.
/// \return distance within which refinePoses() looks for corresponding points, units of the search.
double refinementReach(const PosedSurface& scan, const PosedSurface& model, std::optional<double> max_correspondence);

/// \return distance within which closestPose() looks for them: that within which samples of one surface meet.
double closestReach(const PosedSurface& scan, const PosedSurface& model, std::optional<double> max_correspondence);

/// The final comparison of two surfaces in a pose, with more points than the search.
PoseScore lastScore(const PosedSurface& scan, const PosedSurface& model, const Eigen::Isometry3d& T_model_scan);

/// Refines poses by PCL's point-to-plane ICP, and keeps each pose or its refinement, whichever has the greater merit.
/// \param scan,model in search frames.
/// \param poses poses from searchPoses(), best first, at least one. Poses with much less merit than the best are left
/// out.
/// \param options options of the refinement; max_correspondence in units of the search.
/// \return distinct poses, at least one, best first; T_model_scan between search frames.
std::vector<RankedPose> refinePoses(const PosedSurface& scan, const PosedSurface& model,
                                    const std::vector<RankedPose>& poses, const CloudRegistrationOptions& options);

/// Refines poses with pairs as close as the points allow. Otherwise parts that only one of two scans shows are paired
/// with the border of the other one, and attract it as far as ICP reaches.
/// \param starts T_model_scan between search frames.
/// \return a pose for each start, without scores.
std::vector<RankedPose> closestPoses(const PosedSurface& scan, const PosedSurface& model,
                                     const std::vector<Eigen::Isometry3d>& starts,
                                     const CloudRegistrationOptions& options);

/// Refines a pose from refinePoses() once more by closestPoses().
/// \return the pose itself if it has clearly more merit.
RankedPose closestPose(const PosedSurface& scan, const PosedSurface& model, const RankedPose& pose,
                       const CloudRegistrationOptions& options);

}  // namespace pcl_symmetry
