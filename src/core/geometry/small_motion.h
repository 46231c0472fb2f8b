/// Gauss-Newton steps of small motions: a rotation vector omega, radians, then a translation t, which move x to
/// x + omega x x + t.
#pragma once

#include <Eigen/Geometry>

#include "core/base/symmetric_solvers.h"

namespace pcl_symmetry {

/// The weighted sum of x x^T over rows x of seven numbers: six unknowns and a right side.
class WeightedProducts {
public:
  static constexpr int kLast = 6;  ///< index of the right side
  using Matrix = Eigen::Matrix<double, kLast + 1, kLast + 1>;

  void add(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double last, double weight) {
    Eigen::Matrix<double, kLast + 1, 1> row;
    row << first, second, last;
    sums_.noalias() += weight * row * row.transpose();
  }

  /// The weighted sum of the products of all rows that were added.
  const Matrix& sums() const { return sums_; }
  Matrix6d ofUnknowns() const { return sums_.topLeftCorner<kLast, kLast>(); }

private:
  Matrix sums_ = Matrix::Zero();
};

/// The motion of least squares, -h^-1 g. Directions that nothing fixes stay as they are.
/// \param h symmetric; its lower half is read.
/// \param min_stiffness of a direction that is fixed, share of the greatest eigenvalue of \p h.
/// \param longest a longer motion is cut to this length.
inline Vector6d smallMotion(const Matrix6d& h, const Vector6d& g, double min_stiffness, double longest) {
  Vector6d motion = -SymmetricEigen<Matrix6d>(h).solve(g, min_stiffness);
  const double length = motion.norm();
  return length > longest ? Vector6d(motion * (longest / length)) : motion;
}

inline Eigen::Matrix3d rotationBy(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

inline Eigen::Isometry3d motionBy(const Vector6d& motion) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotationBy(motion.head<3>());
  result.translation() = motion.tail<3>();
  return result;
}

}  // namespace pcl_symmetry
