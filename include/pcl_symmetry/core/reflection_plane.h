#pragma once

#include <Eigen/Geometry>

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A straight line, such as an axis of rotation: a point of it and its direction, unit.
using Line3d = Eigen::ParametrizedLine<double, 3>;

/// A plane of reflection gamma = { x : n.x = r } with unit normal n and signed offset r (Section 3 of the paper).
///
/// Invariant: |n| = 1. (n, r) and (-n, -r) are the same plane: compare canonical forms, or use angleTo().
class ReflectionPlane {
public:
  /// The plane z = 0.
  ReflectionPlane() = default;

  /// The plane normal . x = offset.
  /// \param normal finite and not zero; it is normalized, and the offset is divided by its length.
  /// \param offset normal.x for points x of the plane, input units times the length of the normal.
  /// \throws std::invalid_argument for a zero normal or a value that is not finite.
  ReflectionPlane(const Eigen::Vector3d& normal, double offset);

  /// The plane that reflects \p x onto \p y.
  /// \throws std::invalid_argument for equal points.
  static ReflectionPlane between(const Eigen::Vector3d& x, const Eigen::Vector3d& y);

  const Eigen::Vector3d& normal() const { return normal_; }  ///< n, unit, input frame
  double offset() const { return offset_; }                  ///< r, input units

  /// \return [n, -r], the coefficients of n.x - r = 0, as in PCL's plane models.
  Eigen::Vector4d coefficients() const { return {normal_.x(), normal_.y(), normal_.z(), -offset_}; }

  /// \return n.x - r, input units.
  double signedDistance(const Eigen::Vector3d& x) const { return normal_.dot(x) - offset_; }

  /// \return the reflected point, x - 2 (n.x - r) n.
  Eigen::Vector3d reflect(const Eigen::Vector3d& x) const { return x - 2.0 * signedDistance(x) * normal_; }

  /// \return the reflection as an affine map, of determinant -1.
  Eigen::Affine3d reflection() const;

  /// \return the same plane with a normal of theta in [0, pi/2]: n_z > 0, or n_z = 0 and n_y > 0, or n_y = n_z = 0 and
  /// n_x > 0.
  ReflectionPlane canonical() const;

  /// \return the image of this plane under the rigid motion x -> T x.
  ReflectionPlane transformed(const Eigen::Isometry3d& motion) const;

  /// \return this plane in the frame (x - center) / scale.
  ReflectionPlane normalized(const Eigen::Vector3d& center, double scale = 1.0) const {
    return ReflectionPlane(normal_, -signedDistance(center) / scale);
  }

  /// \return angle between the lines along the two normals, in [0, pi/2] radians.
  double angleTo(const ReflectionPlane& other) const;

private:
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
  double offset_ = 0.0;
};

/// A plane through a line.
/// \param angle angle about the line, radians: at 0, the normal is line.direction().unitOrthogonal().
/// \return the plane, which contains the line.
ReflectionPlane planeThrough(const Line3d& line, double angle);

}  // namespace pcl_symmetry
