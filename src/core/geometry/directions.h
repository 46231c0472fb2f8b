#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace pcl_symmetry {

/// Fractional part of the golden ratio, (sqrt(5) - 1) / 2; its multiples modulo 1 fill [0, 1) evenly after any number
/// of terms.
constexpr double kGoldenSection = 0.61803398874989485;

/// Rotation from one point of a Fibonacci lattice to the next, radians: 2 pi (1 - kGoldenSection).
constexpr double kGoldenAngle = 2.39996322972865332;

/// Term \p k of the golden-ratio sequence, which spreads evenly over an interval for any number of terms.
/// \return fractional part of k * kGoldenSection, in [0, 1).
double goldenFraction(int k);

/// A direction of a spiral over the upper half sphere, which represents all lines through a point.
///
/// The heights z = (k + 1/2) / count cut the half sphere into rings of equal area. An even spiral (Fibonacci lattice)
/// has angles that advance by kGoldenAngle, or 2 pi times goldenFraction().
/// \param k in [0, count).
/// \param count number of directions, >= 1.
/// \param angle angle about z, from x, in radians.
/// \return unit vector with z > 0.
Eigen::Vector3d spiralDirection(int k, int count, double angle);

/// Directions spread evenly over the whole sphere, on a spiral (Fibonacci lattice).
/// \param num_directions >= 1.
/// \return unit vectors by decreasing z.
/// \throws std::invalid_argument for less than one direction.
std::vector<Eigen::Vector3d> evenDirections(int num_directions);

/// \param axis unit.
/// \param angle angle about the axis, radians; at 0 the direction is axis.unitOrthogonal().
/// \return a unit vector at right angles to the axis.
template <typename Scalar>
Eigen::Matrix<Scalar, 3, 1> directionAcross(const Eigen::Matrix<Scalar, 3, 1>& axis, Scalar angle) {
  const Eigen::Matrix<Scalar, 3, 1> u = axis.unitOrthogonal(), v = axis.cross(u);
  return std::cos(angle) * u + std::sin(angle) * v;
}

/// \param a,b not zero.
/// \return angle between the lines along two directions, in [0, pi/2] radians.
inline double angleBetweenLines(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

/// Whether the line along a direction is near the line along the direction of any entry of a list.
/// \param direction unit.
/// \param cosine lines are near if |cos(angle)| exceeds it.
/// \param direction_of a member or a function of the entries that gives a unit vector.
template <typename List, typename Direction, typename Scalar, typename DirectionOf>
bool isNearAny(const List& list, const Direction& direction, Scalar cosine, const DirectionOf& direction_of) {
  return std::any_of(list.begin(), list.end(), [&](const auto& entry) {
    return std::abs(std::invoke(direction_of, entry).dot(direction)) > cosine;
  });
}

/// The same for a list of directions.
template <typename Direction, typename Scalar>
bool isNearAny(const std::vector<Direction>& list, const Direction& direction, Scalar cosine) {
  return isNearAny(list, direction, cosine, [](const Direction& other) -> const Direction& { return other; });
}

/// The axes of a camera: a right-handed frame whose third axis looks along a direction. The rotation about that
/// direction is arbitrary, but always the same.
/// \param forward unit vector, input frame.
/// \return rotation R_camera_input: rows right, down and forward in the input frame.
inline Eigen::Matrix3d viewingFrame(const Eigen::Vector3d& forward) {
  Eigen::Matrix3d R_camera_input;
  R_camera_input.row(2) = forward;
  R_camera_input.row(0) = forward.unitOrthogonal();
  R_camera_input.row(1) = forward.cross(R_camera_input.row(0).transpose());
  return R_camera_input;
}

/// Number of rotations that map the coordinate axes onto each other.
/// 6 orders of the axes times 8 choices of sign, half of which are reflections.
constexpr int kNumAxisRotations = 24;

/// All rotations that map the coordinate axes onto each other. A frame whose axes have no known order and sign can be
/// aligned with another frame in these ways.
/// \return signed permutation matrices of determinant 1, the identity first.
const std::array<Eigen::Matrix3i, kNumAxisRotations>& axisRotations();

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
