#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/rotation/rotation_group.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

struct ObjectSymmetryOptions {
  int num_cells = 64;         ///< of the distance transform along each side, in [8, 512]
  int num_directions = 3000;  ///< of axes, on a half sphere, >= 100: 3000 are 2.6 degrees apart
  int max_fold = 24;          ///< greatest order of a rotation that is looked for, >= 2
  int max_points = 10'000;    ///< of larger clouds so many are drawn, >= 100
  /// A rotation that maps a part of the surface off it, in one or more pieces of together more than this share, is no
  /// symmetry: a handle, a notch. In [0, 1].
  double max_feature = 0.01;
  double min_confidence = 0.5;  ///< as of planes, in [0, 1]
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Turns by every angle about the line through \p offset along \p axis are symmetries.
struct ContinuousSymmetry {
  Eigen::Vector3d axis;    ///< unit
  Eigen::Vector3d offset;  ///< a point of the line, input frame
};

/// The rotations that map a shape onto itself.
struct ObjectSymmetries {
  RotationGroupKind kind = RotationGroupKind::Cyclic;
  int fold = 1;                                      ///< of the main axis; 0 where it is one of revolution
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< that all axes pass through, input frame
  /// Rotations, as motions x -> T x in the input frame; the identity is left out. With it they are a group, exactly but
  /// for rounding. Of a cylinder the one turn by pi about an axis across its own.
  std::vector<Eigen::Isometry3d> discrete;
  /// One for a body of revolution. A sphere has three perpendicular ones: turns about two of them generate all others.
  std::vector<ContinuousSymmetry> continuous;
  double support = 1.0;     ///< share of the surface that the rotations map onto it, as far as sampling lets it, [0, 1]
  double confidence = 1.0;  ///< that the rotations are symmetries, as of planes, in [0, 1]
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order
  std::string reason;  ///< why there is no answer, set by detectObjectSymmetries() for clouds; empty where there is one

  std::string name() const { return nameOf(kind, fold); }
};

/// The group of rotations of a shape, complete: those that its planes of symmetry generate, and those that are there
/// without any plane, as of a propeller.
///
/// Axes are looked for in all directions through the center of mass, by the distance transform; the rotations about
/// those found are made precise and judged by the surface, as planes are; the greatest group that explains them is
/// then fitted as a whole, and has to stand the same test. What the surface cannot tell from a symmetry counts as one:
/// a plate whose sides differ by a hundredth is square, a prism of 16 sides is round. \param points 3 x N, finite,
/// input units; at least 20 different ones, not all on a line. They show the object from all sides. \throws
/// std::invalid_argument for bad options, values that are not finite, and too few points.
ObjectSymmetries objectSymmetries(const PointsRef& points, const ObjectSymmetryOptions& options = {});

}  // namespace pcl_symmetry
