#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/base/symmetric_solvers.h"

namespace pcl_symmetry {

/// A constraint on the pose of two scans.
struct PoseConstraint {
  int source, target;
  Eigen::Isometry3d T_target_source;
  Matrix6d information;  ///< inverse covariance of the small motion of the target's frame that corrects the pose
};

/// Moves scans to the poses that agree best with all constraints, by Gauss-Newton. Scans that constraints do not
/// connect do not move relative to each other.
/// \param[in,out] T_world_scan pose of each scan, where the steps begin.
void adjustPoses(const std::vector<PoseConstraint>& constraints, std::vector<Eigen::Isometry3d>& T_world_scan,
                 int num_steps);

/// The result of registering two scans.
struct PairAnswer {
  int source, target;
  Eigen::Isometry3d T_target_source;
  Matrix6d covariance;  ///< covariance of the small motion of the target's frame that corrects the pose
  double weight = 0.0;  ///< 1 for a pose that converged, less for a doubtful one, 0 for a bad one
  bool converged = false;
};

/// Limits within which two poses of scans count as the same.
struct SamePose {
  double angle, distance;  ///< radians and units of the scans
  /// \param T_a_b,other poses, compared by their rotations and by where they put the origin of b.
  bool operator()(const Eigen::Isometry3d& T_a_b, const Eigen::Isometry3d& other) const;
};

/// Scans in groups, within which poses are known.
struct ScanGroups {
  std::vector<int> group;                       ///< group of each scan
  std::vector<Eigen::Isometry3d> T_group_scan;  ///< pose of each scan in its group

  /// \return whether the scans of an answer are in one group and the answer agrees with their poses.
  bool agrees(const PairAnswer& answer, const SamePose& same) const;
};

/// Joins scans by the answers of their pairs, the most certain first: all answers between two groups vote for the pose
/// that joins them, each for itself and for what agrees with it, and against what does not. At the start, the votes of
/// a pair are those of the triangles that it closes.
/// \param min_votes least sum of weights that joins two groups: 1 for one pair that converged.
ScanGroups joinScans(int num_scans, const std::vector<PairAnswer>& answers, const SamePose& same, double min_votes);

}  // namespace pcl_symmetry
