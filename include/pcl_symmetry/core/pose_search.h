#pragma once

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Options of the search for poses that bring a scan, or a whole object, to a model of it (Section 5.1).
struct PoseSearchOptions {
  int num_rotations = 1000;  ///< rotations spread evenly over all rotations, tried in addition to the given poses, >= 0
  int num_screened = 60;     ///< best of these rotations, improved coarsely together with all given poses, >= 1
  int num_refined = 20;      ///< best distinct poses after the coarse improvement, improved finely, >= 1
  int max_poses = 4;         ///< greatest number of distinct poses returned, >= 1
  int num_threads = 0;       ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Agreement of two clouds at a pose.
struct PoseScore {
  double support = 0.0;  ///< share of the scan's points that lie on the model, in [0, 1]
  /// Sum of two shares, in [0, 2]: the model's points that lie in the scanner's free space, among those that it could
  /// judge, and the scan's points that lie in the free space of the model's scanner.
  double conflict = 0.0;

  /// Merit of a pose, by which poses are compared, in [-1, 1]: 1 for a perfect pose. Conflict counts half, because
  /// holes in a scan look like free space.
  double merit() const { return support - 0.5 * conflict; }
};

/// Evidence that a pose is right. Two scans need not show the same part of an object: only points that face the surface
/// of the other cloud, and not its border, have to lie on it.
struct PoseEvidence {
  double overlap_source = 0.0;  ///< share of the source's points that lie on the surface of the target, in [0, 1]
  double overlap_target = 0.0;  ///< share of the target's points that lie on the surface of the source, in [0, 1]
  double agreement = 0.0;       ///< share of the points facing the other surface that lie on it, in [0, 1]
  /// Lower limit of the share of the scan's points that lie on the surface of the model, in [0, 1]: points count by a
  /// Gaussian of their distance, 2.5 % of the model's radius wide.
  double on_surface = 0.0;
  /// Share of one cloud's surface that the other cloud's scanner should see at this pose, but that lies in free space
  /// in front of its measurements, in [0, 1]. The greater of the two shares if both clouds were scanned; 0 if neither
  /// was.
  double contradicted = 0.0;
  /// The same share for space where the scanner measured nothing, beside the cloud or in its holes.
  double missing = 0.0;
  /// The share counted by `contradicted` or `missing`, in [0, 1], that lies farther than 5 % of the smaller diameter
  /// from everything measured.
  double aside = 0.0;
  /// Share of the surface, in [0, 1], in parts that only one of the clouds has: what is missing beyond the outline of
  /// what was measured, or contradicted far from it, less what is missing within the outline, as holes would be in both
  /// places; or what a scan shows farther than 5 % of the smaller diameter from a model of the whole object, but for
  /// its open borders.
  double outside = 0.0;
  double noise = 0.0;       ///< noise of the noisier cloud, in diameters of the smaller one
  double size_ratio = 1.0;  ///< diameter of the source divided by that of the target
  /// Share of this pose in the summed odds of all judged poses, in (0, 1]: 0.5 if another pose fits equally well. Poses
  /// that differ by a symmetry of the model, or by a motion that contradicts neither scan, count as one. 1 if the pose
  /// by itself is not convincing.
  double uniqueness = 1.0;
};

}  // namespace pcl_symmetry
