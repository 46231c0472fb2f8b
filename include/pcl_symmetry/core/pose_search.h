#pragma once

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Options of the search for poses that bring a scan, or a whole object, to a model of it (Section 5.1).
struct PoseSearchOptions {
  int num_rotations = 1000;  ///< spread evenly over all rotations, tried beside the given poses, >= 0
  int num_screened = 60;     ///< the best of these that are improved coarsely, with all given poses, >= 1
  int num_refined = 20;      ///< the best of those that are improved finely, >= 1
  int max_poses = 4;         ///< the best of those that are returned, >= 1
  int num_threads = 0;       ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Agreement of two clouds at a pose.
struct PoseScore {
  double support = 0.0;  ///< share of the scan's points that lie on the model, in [0, 1]
  /// Sum of two shares, in [0, 2]: of the model's points that the scanner could judge, those in its free space; and of
  /// the scan's points, those in the free space of the model's scanner.
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
  double agreement = 0.0;       ///< of the points that face the other surface, the share that lies on it, in [0, 1]
  /// Lower limit of the share of the scan's points that lie on the surface of the model within 2 % of its radius or
  /// what noise requires, in [0, 1].
  double on_surface = 0.0;
  /// Share of the surface of a cloud that the scanner of the other one should see at this pose, but that lies in free
  /// space in front of its measurements, in [0, 1]. The greater one if both were scanned; 0 if neither was.
  double contradicted = 0.0;
  /// The same for space where it measured nothing: beside the cloud or in its holes.
  double missing = 0.0;
  /// The share of both, in [0, 1], that lies farther than 5 % of the smaller diameter from all that it measured: a part
  /// that only one of the clouds has.
  double aside = 0.0;
  double noise = 0.0;       ///< of the noisier cloud, in diameters of the smaller one
  double size_ratio = 1.0;  ///< diameter of the source over that of the target
  /// Share of the pose in the odds of all that were judged, in (0, 1]: 0.5 where another one fits as well. Poses that
  /// differ by a symmetry of the model, or between two scans by a motion that neither of them counts against, are one.
  /// 1 where the pose alone does not convince.
  double uniqueness = 1.0;
};

}  // namespace pcl_symmetry
