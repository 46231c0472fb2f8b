#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/rotation_group.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

class MeshSurface;

/// Options of objectSymmetries(): what symmetric means, and limits of the search.
struct ObjectSymmetryOptions {
  int num_cells = 64;         ///< cells of the distance transform along each side, in [8, 512]
  int num_directions = 3000;  ///< directions of axes on a half sphere, >= 100; 3000 are 2.6 degrees apart
  int max_fold = 60;          ///< greatest order of a rotation, >= 2
  int max_points = 10'000;    ///< number of points drawn from larger clouds, >= 100
  /// Definition of a symmetry: greatest deviation of a surface, as a share of the greatest distance between two points,
  /// in (0, 0.1]. A rotation is a symmetry if it maps at least 1 - max_feature of the surface to within this distance
  /// of the surface.
  double tolerance = 0.01;
  /// The same tolerance in input units, >= 0; 0 = `tolerance` is used.
  double absolute_tolerance = 0.0;
  /// Greatest share of the surface that a symmetry may map off the surface, in one or more pieces together, in [0, 1]:
  /// a plug, a notch, a screw. At most an eighth of it may be off by more than ten tolerances: handles are parts, not
  /// features.
  double max_feature = 0.15;
  bool other_tolerances = false;  ///< also finds the groups at half and twice the tolerance
  double min_confidence = 0.5;    ///< least confidence of rotations that are called symmetries, in [0, 1]
  std::uint64_t seed = 1;         ///< seed of all random draws
  int num_threads = 0;            ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// An axis of revolution: rotations by every angle about it are symmetries.
struct ContinuousSymmetry {
  Eigen::Vector3d axis;    ///< unit vector along the axis, input frame
  Eigen::Vector3d offset;  ///< a point of the axis, input frame
};

/// The distance between two poses of an object, up to its symmetries.
struct PoseDistance {
  double angle;   ///< least angle between the first pose and any pose that looks like the second, radians, in [0, pi]
  double offset;  ///< distance between the two positions of ObjectSymmetries::center, input units
};

/// Rotations about a line that are no symmetries, and why.
struct RejectedRotation {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  ///< one of the rotations, x -> T x in the input frame
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();           ///< unit vector along the axis, input frame
  int fold = 0;                                              ///< order of the rotations; 0 = by any angle
  double off = 0.0;                                          ///< share of the surface beyond the tolerance, in [0, 1]
  double far = 0.0;                                          ///< share beyond ten tolerances, in [0, 1]
  Eigen::Vector3d where = Eigen::Vector3d::Zero();  ///< center of the part of the surface that is off, input frame
};

/// A group by its name.
struct GroupName {
  RotationGroupKind kind = RotationGroupKind::Cyclic;  ///< which of the finite or continuous groups
  int fold = 1;                                        ///< order of the main axis; 0 for an axis of revolution

  std::string name() const { return nameOf(kind, fold); }  ///< name of the group, see nameOf()
};

/// The rotations that map a shape onto itself.
///
/// A pose T maps the input frame to any other one, such as that of a camera. The pose T S looks like T for every
/// symmetry S. The methods below take all symmetries into account: the rotations of a continuous group in closed form,
/// without samples of their angles. `discrete` and `continuous` together form a group; detection and from() ensure
/// that.
struct ObjectSymmetries {
  RotationGroupKind kind = RotationGroupKind::Cyclic;  ///< which of the finite or continuous groups
  int fold = 1;                                        ///< order of the main axis; 0 for an axis of revolution
  /// The point that all axes pass through, input frame; the center of the bounding ball where there is no axis.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  /// Rotations as motions x -> T x in the input frame, without the identity, with which they form a group, exact but
  /// for rounding. A cylinder has one: a half turn about an axis perpendicular to its own.
  std::vector<Eigen::Isometry3d> discrete;
  /// One axis for a body of revolution, three perpendicular ones for a sphere: rotations about two of them generate all
  /// rotations.
  std::vector<ContinuousSymmetry> continuous;
  /// Share of the surface that each rotation maps to within the tolerance of the surface, relative to what sampling and
  /// noise allow, in [0, 1]; for rotations by any angle, their mean.
  double support = 1.0;
  double confidence = 1.0;   ///< probability that the whole surface, not only its points, keeps within the limits
  double tolerance = 0.0;    ///< tolerance of the decision, input units
  int num_stray_points = 0;  ///< points far from all others, which were left out
  /// Group at half the tolerance, with ObjectSymmetryOptions::other_tolerances.
  std::optional<GroupName> at_half_tolerance;
  /// Group at twice the tolerance, with ObjectSymmetryOptions::other_tolerances.
  std::optional<GroupName> at_twice_tolerance;
  std::vector<RejectedRotation> rejected;                 ///< rotations that were rejected, the least failure first
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order, with their milliseconds
  /// Why there is no answer; empty where there is one. For points that show no surface at the tolerance (solid samples,
  /// atoms, few points) it names the least tolerance at which they do.
  std::string reason;

  std::string name() const { return nameOf(kind, fold); }  ///< name of the group, see nameOf()

  /// The group that given motions and axes generate, exact but for rounding, as for symmetries that people wrote into a
  /// file. A sphere may be given by two axes of revolution, or by one and a motion that tilts it.
  /// \param discrete rigid motions in the input frame, the identity or not; each rotates by less than half a degree
  /// from an element of the group.
  /// \param continuous axes of revolution, not zero, of any length.
  /// \throws std::invalid_argument where the motions generate no group of at most 240 rotations, or a motion shifts the
  /// axes off the common center.
  static ObjectSymmetries from(const std::vector<Eigen::Isometry3d>& discrete,
                               const std::vector<ContinuousSymmetry>& continuous);

  /// The poses that look like T.
  /// \param step radians, > 0: rotations about an axis of revolution are at most this far apart. For a sphere, every
  /// rotation lies within half a step of one of the result; their number grows with its third power.
  /// \return T first.
  /// \throws std::invalid_argument for a step that is not > 0.
  std::vector<Eigen::Isometry3d> equivalents(const Eigen::Isometry3d& T, double step = 0.5) const;

  /// The pose that looks like T and is rotated least from \p T_previous: the pose that continues a track. Whichever of
  /// the equivalent poses T is, this rotation is never greater than the rotation of the object itself.
  Eigen::Isometry3d closestTo(const Eigen::Isometry3d& T, const Eigen::Isometry3d& T_previous) const;

  /// One pose for all that look the same: the one with the smallest rotation, among equals the one whose matrix is
  /// greatest column by column (a body of revolution upside down: a fixed one of its half turns). Poses that look the
  /// same have the same result but for rounding. No such choice can be continuous: use closestTo() along a track.
  Eigen::Isometry3d canonical(const Eigen::Isometry3d& T) const;

  /// The distance between two poses, up to the symmetries.
  PoseDistance distance(const Eigen::Isometry3d& T_1, const Eigen::Isometry3d& T_2) const;

  /// Maximum symmetry-aware surface distance (MSSD of the BOP benchmark): the greatest distance of a point between the
  /// two poses, minimized over all poses that look like T_2. Exact for rotations about an axis; for spheres, the
  /// distance between the centers.
  /// \param points 3 x N, finite, input frame; N >= 1. The vertices of a mesh, or of its convex hull, are enough.
  /// \return distance, input units.
  /// \throws std::invalid_argument without a point.
  double surfaceDistance(const Eigen::Isometry3d& T_1, const Eigen::Isometry3d& T_2, const PointsRef& points) const;
};

/// Finds the group of rotations of a shape, with planes of symmetry, which generate rotations, or without, such as a
/// propeller. It extends the paper's transform and refinement from reflections to
/// rotations, as its future work suggests (Section 6).
///
/// The distance transform shows in which directions axes through the center of mass are likely. Rotations about these
/// axes are refined as planes are, and judged by the share of the surface that they map to within the tolerance of the
/// surface. A fold is accepted only if the rotations halfway between its own fail clearly more; if all rotations fit,
/// the axis is one of revolution. The greatest group that explains the axes is then fitted as a whole, and must fit as
/// a whole.
/// \param points 3 x N, finite, input units; at least 20 distinct ones, not all on a line, that show the object from
/// all sides.
/// \param options what symmetric means, and limits of the search.
/// \return the group, in the input frame; C_1 for a shape without symmetry, and, with a reason, confidence 0 and
/// support 0, for points that resolve no answer.
/// \throws std::invalid_argument for bad options, values that are not finite, too few points and points on a line.
ObjectSymmetries objectSymmetries(const PointsRef& points, const ObjectSymmetryOptions& options = {});

/// The same for a mesh: the group, as a whole, is moved to where it maps the mesh best onto itself. If the points do
/// not resolve the tolerance, the group found at the default tolerance is also accepted if the mesh keeps within the
/// limits.
/// \param points points spread over the mesh.
ObjectSymmetries objectSymmetries(const PointsRef& points, const MeshSurface& mesh,
                                  const ObjectSymmetryOptions& options = {});

}  // namespace pcl_symmetry
