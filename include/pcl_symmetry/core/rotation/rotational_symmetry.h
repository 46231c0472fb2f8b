#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/rotation/rotation_group.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

struct ObjectSymmetryOptions {
  int num_cells = 64;         ///< cells of the distance transform along each side, in [8, 512]
  int num_directions = 3000;  ///< directions of axes on a half sphere, >= 100; 3000 are 2.6 degrees apart
  int max_fold = 24;          ///< greatest order of a rotation, >= 2
  int max_points = 10'000;    ///< number of points drawn from larger clouds, >= 100
  /// Greatest share of the surface, in one or more pieces together, that a symmetry may map off the surface: a handle,
  /// a notch. In [0, 1].
  double max_feature = 0.01;
  double min_confidence = 0.5;  ///< least confidence, as for planes, in [0, 1]
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// An axis of revolution: turns by every angle about it are symmetries.
struct ContinuousSymmetry {
  Eigen::Vector3d axis;    ///< unit, input frame
  Eigen::Vector3d offset;  ///< a point of the axis, input frame
};

/// The rotations that map a shape onto itself.
struct ObjectSymmetries {
  RotationGroupKind kind = RotationGroupKind::Cyclic;
  int fold = 1;  ///< order of the main axis; 0 where it is one of revolution
  /// The point that all axes pass through, input frame; the center of the bounding ball where there is no axis.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  /// Rotations as motions x -> T x in the input frame, without the identity. Together with it they are a group, exactly
  /// but for rounding. A cylinder has one: a half turn about an axis across its own.
  std::vector<Eigen::Isometry3d> discrete;
  /// One axis for a body of revolution, three perpendicular ones for a sphere: turns about two of them generate all
  /// rotations.
  std::vector<ContinuousSymmetry> continuous;
  /// Share of the surface that the rotations map onto the surface, as far as sampling lets it, in [0, 1].
  double support = 1.0;
  double confidence = 1.0;  ///< probability that the rotations are symmetries, as for planes, in [0, 1]
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
  std::string reason;  ///< why there is no answer, set by detectObjectSymmetries() for clouds; empty where there is one

  std::string name() const { return nameOf(kind, fold); }
};

/// Finds the group of rotations of a shape: both the rotations that planes of symmetry generate and those of shapes
/// without any plane, such as propellers. It carries the paper's transform and refinement over from reflections to
/// rotations, as its future work suggests (Section 6).
///
/// The distance transform tells in which directions axes through the center of mass are likely. The rotations about
/// these axes are refined and judged as planes are. The greatest group that explains them is then fitted as a whole,
/// and has to pass the same test. What the surface cannot tell from a symmetry counts as one: a plate whose sides
/// differ by a hundredth is square, a prism of 16 sides is round.
/// \param points 3 x N, finite, input units; at least 20
/// distinct ones, not all on a line, that show the object from all sides.
/// \param options limits of the search.
/// \return
/// the group, in the input frame; C_1 for a shape without symmetry.
/// \throws std::invalid_argument for bad options,
/// values that are not finite, too few points and points on a line.
ObjectSymmetries objectSymmetries(const PointsRef& points, const ObjectSymmetryOptions& options = {});

}  // namespace pcl_symmetry
