/// Frames that the symmetries of a mesh leave equally good: what every method is compared by alike.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "evaluate/references/reference_symmetries.h"

namespace pcl_symmetry::apps {

/// Turns that take the axes of a frame, without their order and signs, to others that no symmetry tells from them.
struct MeshTies {
  std::vector<Eigen::Matrix3d> turns;   ///< the identity first
  std::optional<Eigen::Vector3d> axis;  ///< turns by any angle about it are allowed too
  bool all = false;                     ///< a sphere: every turn is allowed
};

/// \param references of the mesh, found without the methods that are compared.
MeshTies tiesOf(const ReferenceSymmetries& references);

/// Degrees of the rotation between the axes of \p a and those of \p b, the smallest over any order and sign of the
/// axes and over the turns.
double angleUpToTies(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, const MeshTies& ties);

}  // namespace pcl_symmetry::apps
