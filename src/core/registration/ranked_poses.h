#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "core/registration/pose_scoring.h"
#include "pcl_symmetry/core/pose_search.h"

namespace pcl_symmetry {

/// Steps with a Gaussian whose width shrinks geometrically.
struct PoseImprovement {
  int num_steps, num_points;
  double first_width, last_width;  ///< radii
};

struct RankedPose {
  Eigen::Isometry3d T_model_scan = Eigen::Isometry3d::Identity();
  PoseScore score;
  int num_points = 0;  ///< of the scan that the pose was fitted to; 0 = it was not fitted

  /// \param unit radius of the model, in the unit of the pose.
  void improve(const PoseScorer& scorer, const PoseImprovement& how, double unit = 1.0);
};

/// The first poses, at most \p most, that differ from all before them.
/// \param radius of the model, in the unit of the poses.
std::vector<RankedPose> firstDistinct(const std::vector<RankedPose>& poses, std::size_t most, double radius = 1.0);

/// The poses of greatest merit, at most \p most, that differ from all better ones.
std::vector<RankedPose> distinctPoses(std::vector<RankedPose> poses, std::size_t most, double radius = 1.0);

/// A few distinct poses of greatest merit (Section 5.1). Evenly spread rotations are screened by merit. The best of
/// them and all hypotheses are improved coarsely, the best of those finely, by Gauss-Newton steps with a shrinking
/// Gaussian.
/// \param scan,model each about its own center, in units of the model's radius.
/// \param hypotheses T_model_scan to improve beside the screened ones, such as those that bring frames together.
/// \return best first.
/// \throws std::invalid_argument for bad options.
std::vector<RankedPose> searchPoses(const PosedSurface& scan, const PosedSurface& model,
                                    const std::vector<Eigen::Isometry3d>& hypotheses,
                                    const PoseSearchOptions& options = {});

}  // namespace pcl_symmetry
