#pragma once

#include <Eigen/Core>

#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// A line of reflection in the plane, { x : n.x = r } with unit normal n = (cos theta, sin theta) and signed offset r:
/// the two-dimensional case of ReflectionPlane (Section 4.2).
///
/// (theta, r) and (theta + pi, -r) are the same line: compare canonical forms, or use angleTo().
class ReflectionLine {
public:
  /// The line x = 0.
  ReflectionLine() = default;

  /// \param theta radians. \param offset such that n.x = offset on the line, in the units of x.
  /// \throws std::invalid_argument where a value is not finite.
  ReflectionLine(double theta, double offset);

  double theta() const { return theta_; }
  double offset() const { return offset_; }
  const Eigen::Vector2d& normal() const { return normal_; }

  /// \return n.x - r.
  double signedDistance(const Eigen::Vector2d& x) const { return normal_.dot(x) - offset_; }

  /// \return x - 2 (n.x - r) n.
  Eigen::Vector2d reflect(const Eigen::Vector2d& x) const { return x - 2.0 * signedDistance(x) * normal_; }

  /// The same line with theta in [0, pi).
  ReflectionLine canonical() const;

  /// Angle between the two lines, in [0, pi/2] radians.
  double angleTo(const ReflectionLine& other) const;

private:
  double theta_ = 0.0;
  double offset_ = 0.0;
  Eigen::Vector2d normal_ = Eigen::Vector2d::UnitX();
};

}  // namespace pcl_symmetry
