#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The groups of rotations about a point that shapes can have: there are no others.
enum class RotationGroupKind {
  Cyclic,       ///< C_n: rotations about one axis by multiples of 2 pi / n; C_1 is the identity alone
  Dihedral,     ///< D_n: C_n, and half turns about n axes perpendicular to it
  Tetrahedral,  ///< T: the regular tetrahedron, 12 rotations
  Octahedral,   ///< O: the cube and the regular octahedron, 24 rotations
  Icosahedral,  ///< I: the regular dodecahedron and icosahedron, 60 rotations
  Revolution,   ///< rotations by any angle about one axis
  Cylindrical,  ///< Revolution, and half turns about every axis perpendicular to it
  Spherical     ///< every rotation
};

/// Whether the group holds rotations by every angle.
inline bool isContinuous(RotationGroupKind kind) {
  return kind >= RotationGroupKind::Revolution;
}

/// The rotation about a line through the origin.
/// \param axis unit.
/// \param angle radians.
Eigen::Matrix3d rotationAbout(const Eigen::Vector3d& axis, double angle);

/// The rotation R about a point c as a motion, x -> R (x - c) + c.
Eigen::Isometry3d motionFixing(const Eigen::Vector3d& center, const Eigen::Matrix3d& rotation);

/// The rotation about a line as a motion.
/// \param angle radians.
Eigen::Isometry3d motionAbout(const Line3d& line, double angle);

/// A line as a direction: the one of its two directions whose largest coordinate is positive.
Eigen::Vector3d signedDirection(const Eigen::Vector3d& direction);

/// A finite group of rotations in a frame of its own, exact but for rounding.
///
/// C_n and D_n have their main axis along z, D_n a half turn about x. The axes of order 2 of T and I, and those of
/// order 4 of O, are x, y and z.
struct RotationGroup {
  RotationGroupKind kind = RotationGroupKind::Cyclic;  ///< which of the finite or continuous groups
  int fold = 1;  ///< n of C_n and D_n; for T, O and I the greatest order of a rotation: 3, 4 and 5

  /// All rotations of the group.
  /// \return the identity first.
  /// \throws std::invalid_argument where the group is continuous or fold < 1.
  std::vector<Eigen::Matrix3d> elements() const;

  /// Rotations that generate the group.
  /// \return one or two rotations; none for C_1.
  /// \throws std::invalid_argument where the group is continuous.
  std::vector<Eigen::Matrix3d> generators() const;
};

/// An axis of a group, through its center.
struct RotationAxis {
  Eigen::Vector3d direction;  ///< unit, its largest coordinate positive
  int order;                  ///< n of the rotations by 2 pi / n about it
};

/// The axes of a group.
/// \param elements closed under composition.
/// \return each axis once.
std::vector<RotationAxis> axesOf(const std::vector<Eigen::Matrix3d>& elements);

/// Name of a group after Schoenflies.
/// \return C3, D4, T, O or I; for the continuous groups Cinf, Dinf and SO3.
std::string nameOf(RotationGroupKind kind, int fold);

}  // namespace pcl_symmetry
