#pragma once

#include <Eigen/Geometry>

#include "core/geometry/weighted_products.h"

namespace pcl_symmetry {

/// Least squares in a small motion (rotation vector, translation).
class MotionEquations {
public:
  /// \param unit of the lengths, > 0, so that turns and translations count alike.
  explicit MotionEquations(double unit) : unit_(unit) {}

  /// w (n . (x + rotation x x + translation) - n . y)^2.
  void addPlane(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& n, double weight) {
    of_planes_.add(x.cross(n) / unit_, n, n.dot(y - x) / unit_, weight);
  }

  /// w |x + rotation x x + translation - y|^2: the sum of addPlane() over three normals.
  void addPoint(const Eigen::Vector3d& x, const Eigen::Vector3d& y, double weight) {
    of_points_.add(x / unit_, (y - x) / unit_, 1.0, weight);
  }

  /// The motion of least squares; no motion where the points fix none.
  Eigen::Isometry3d motion();

private:
  double unit_;
  WeightedProducts of_planes_;  // of lever, normal and distance
  WeightedProducts of_points_;  // of arm, way and 1
};

}  // namespace pcl_symmetry
