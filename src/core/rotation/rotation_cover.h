#pragma once

#include <Eigen/Core>
#include <vector>

namespace pcl_symmetry {

/// Rotations D that tilt an axis everywhere: every rotation is C D H with a rotation C about the axis and a rotation H
/// by at most an angle. With one axis of revolution, they represent a sphere for programs that cannot combine axes with
/// each other.
///
/// The directions D^-1 a lie on rings. The bands around the rings cover the sphere, and the number of directions on
/// each ring follows from its width, so that the angle is a bound, not an estimate.
/// \param axis unit; called a above.
/// \param angle radians, in (0, pi].
/// \return the identity first; about 6.5 / angle^2 rotations.
/// \throws std::invalid_argument for an angle out of range.
std::vector<Eigen::Matrix3d> tiltsCovering(const Eigen::Vector3d& axis, double angle);

}  // namespace pcl_symmetry
