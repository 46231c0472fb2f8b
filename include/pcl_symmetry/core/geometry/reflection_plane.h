#pragma once

#include <Eigen/Geometry>

namespace pcl_symmetry {

/// A plane of reflection gamma = { x : n.x = r } with unit normal n and signed offset r (Section 3 of the paper).
///
/// Invariant: |normal| = 1. (n, r) and (-n, -r) are the same plane: compare canonical forms, or use angleTo().
class ReflectionPlane {
public:
  /// The plane z = 0.
  ReflectionPlane() = default;

  /// \param normal any finite vector but zero; it is normalised, and the offset is divided by its length.
  /// \param offset such that normal.x = offset on the plane, in the units of x.
  /// \throws std::invalid_argument where the normal is zero or a value is not finite.
  ReflectionPlane(const Eigen::Vector3d& normal, double offset);

  /// \param coefficients [a, b, c, d] of a x + b y + c z + d = 0, as PCL's plane models have them.
  static ReflectionPlane fromCoefficients(const Eigen::Vector4d& coefficients);

  /// The plane that reflects \p x onto \p y; the two must differ.
  static ReflectionPlane between(const Eigen::Vector3d& x, const Eigen::Vector3d& y);

  const Eigen::Vector3d& normal() const { return normal_; }
  double offset() const { return offset_; }

  /// [n, -r]: the coefficients of n.x - r = 0.
  Eigen::Vector4d coefficients() const { return {normal_.x(), normal_.y(), normal_.z(), -offset_}; }

  /// \return n.x - r.
  double signedDistance(const Eigen::Vector3d& x) const { return normal_.dot(x) - offset_; }

  /// \return x - 2 (n.x - r) n.
  Eigen::Vector3d reflect(const Eigen::Vector3d& x) const { return x - 2.0 * signedDistance(x) * normal_; }

  /// The reflection as an affine map (a determinant of -1).
  Eigen::Affine3d reflection() const;

  /// The same plane with theta in [0, pi/2]: z > 0, or z = 0 and y > 0, or y = z = 0 and x > 0.
  ReflectionPlane canonical() const;

  /// The image of this plane under a rigid motion x -> T x.
  ReflectionPlane transformed(const Eigen::Isometry3d& motion) const;

  /// Angle between the two normals as lines, in [0, pi/2] radians.
  double angleTo(const ReflectionPlane& other) const;

private:
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
  double offset_ = 0.0;
};

}  // namespace pcl_symmetry
