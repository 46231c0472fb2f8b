#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "core/rotation/rotation_fit.h"
#include "pcl_symmetry/core/axial_transform.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry {

/// A group of rotations with its axes and center, in the normalized frame.
struct PlacedGroup {
  RotationGroupKind kind = RotationGroupKind::Cyclic;
  int fold = 1;
  RotationSet set;  ///< all elements except the identity; for continuous groups, rotations that represent all
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< axis of the first rotation, unit
  OffShares shares;  ///< shares of the worst rotation; for rotations by any angle, the mean

  Line3d line() const { return {set.center, axis}; }
};

/// The groups of the regular solids, the greatest first.
constexpr RotationGroup kPolyhedralGroups[] = {
    {RotationGroupKind::Icosahedral, 5}, {RotationGroupKind::Octahedral, 4}, {RotationGroupKind::Tetrahedral, 3}};

/// The excess above which a set that is judged by kRotation.num_some_points is rejected: three standard errors above 1.
double greatestExcess(const RotationLimits& limits);

/// Moves the set to where it fits the surface best; nothing if the surface does not support it there.
std::optional<PlacedGroup> placedGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                       RotationGroupKind kind, int fold, RotationSet set);

/// The rotation that maps z to \p z, and x as close as possible to \p x.
/// \param z,x not parallel.
Eigen::Matrix3d frameAlong(const Eigen::Vector3d& z, const Eigen::Vector3d& x);

/// All products of rotations, the identity first; more than \p max_count if they generate no group of at most that
/// size.
/// \param same Frobenius norm below which two matrices count as one rotation.
std::vector<Eigen::Matrix3d> productsOf(const std::vector<Eigen::Matrix3d>& generators, double same,
                                        std::size_t max_count = std::numeric_limits<std::size_t>::max() - 1);

/// All elements of a group except the identity, placed by \p frame. The generators are judged and, about a main axis,
/// the rotations by about a quarter and a half turn: for a high fold, one step cannot be distinguished from a step of
/// the next fold.
/// \param frame rotation from the frame of the group to that of the points.
RotationSet elementsOf(const RotationGroup& group, const Eigen::Matrix3d& frame, const Eigen::Vector3d& center);

/// Rotations about a line that represent all rotations about it: their angles fit no polygon.
RotationSet rotationsAbout(const Line3d& line);

}  // namespace pcl_symmetry
