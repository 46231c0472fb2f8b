#pragma once

#include <Eigen/Core>

#include "pcl_symmetry/core/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A line of reflection in the plane, { x : n.x = r } with unit normal n = (cos theta, sin theta) and signed offset r:
/// the planar case of ReflectionPlane (Section 4.2).
///
/// Invariant: |n| = 1. (theta, r) and (theta + pi, -r) are the same line: compare canonical forms, or use angleTo().
class ReflectionLine {
public:
  /// The line x = 0.
  ReflectionLine() = default;

  /// \param theta angle of the normal from the x axis, radians.
  /// \param offset n.x for points x of the line, input units.
  /// \throws std::invalid_argument for a value that is not finite.
  ReflectionLine(double theta, double offset);

  double theta() const { return theta_; }
  double offset() const { return offset_; }
  const Eigen::Vector2d& normal() const { return normal_; }

  /// \return n.x - r, input units.
  double signedDistance(const Eigen::Vector2d& x) const { return normal_.dot(x) - offset_; }

  /// \return the reflected point, x - 2 (n.x - r) n.
  Eigen::Vector2d reflect(const Eigen::Vector2d& x) const { return x - 2.0 * signedDistance(x) * normal_; }

  /// \return the same line with theta in [0, pi).
  ReflectionLine canonical() const;

  /// \return angle between the two lines, in [0, pi/2] radians.
  double angleTo(const ReflectionLine& other) const;

private:
  double theta_ = 0.0;
  double offset_ = 0.0;
  Eigen::Vector2d normal_ = Eigen::Vector2d::UnitX();
};

}  // namespace pcl_symmetry
