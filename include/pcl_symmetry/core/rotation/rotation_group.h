#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The groups of rotations about a point that shapes can have: there are no others.
enum class RotationGroupKind {
  Cyclic,       ///< C_n: about one axis, by multiples of 2 pi / n; C_1 is the identity alone
  Dihedral,     ///< D_n: C_n, and by pi about n axes across it
  Tetrahedral,  ///< T, of the regular tetrahedron, 12 rotations
  Octahedral,   ///< O, of the cube and the regular octahedron, 24 rotations
  Icosahedral,  ///< I, of the regular dodecahedron and icosahedron, 60 rotations
  Revolution,   ///< by any angle about one axis
  Cylindrical,  ///< Revolution, and by pi about any axis across it
  Spherical     ///< every rotation
};

/// Whether rotations by every angle belong to it.
inline bool isContinuous(RotationGroupKind kind) {
  return kind >= RotationGroupKind::Revolution;
}

/// The rotation by \p angle, radians, about the unit vector \p axis.
Eigen::Matrix3d rotationAbout(const Eigen::Vector3d& axis, double angle);

/// Of the two directions of a line the one whose largest coordinate is positive.
Eigen::Vector3d signedDirection(const Eigen::Vector3d& direction);

/// A finite group of rotations in a frame of its own, exact but for rounding.
struct RotationGroup {
  RotationGroupKind kind = RotationGroupKind::Cyclic;
  int fold = 1;  ///< n of C_n and D_n; of the others the greatest order of a rotation: 3, 4 and 5

  /// All of them, the identity first. C_n and D_n turn about z, D_n also about x. The axes of order 2 of T and I, and
  /// those of order 4 of O, are x, y and z. \throws std::invalid_argument where the group is continuous or fold < 1.
  std::vector<Eigen::Matrix3d> elements() const;

  /// Rotations that generate the group: one or two, none for C_1.
  std::vector<Eigen::Matrix3d> generators() const;
};

/// A line through the center that a group turns about.
struct RotationAxis {
  Eigen::Vector3d direction;  ///< unit, its largest coordinate positive
  int order;                  ///< of the rotations about it
};

/// Each axis of a group once. \param elements closed under composition.
std::vector<RotationAxis> axesOf(const std::vector<Eigen::Matrix3d>& elements);

/// Schoenflies' name: C3, D4, T, O, I, and for the continuous ones Cinf, Dinf and SO3.
std::string nameOf(RotationGroupKind kind, int fold);

}  // namespace pcl_symmetry
