/// Small motions, a rotation vector omega (radians) and a translation t, which move x to x + omega x x + t, and their
/// Gauss-Newton steps.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/base/symmetric_solvers.h"

namespace pcl_symmetry {

/// The weighted sum of x x^T over rows x of seven numbers: six unknowns and a right side.
class WeightedProducts {
public:
  static constexpr int kLast = 6;  ///< index of the right side
  using Matrix = Eigen::Matrix<double, kLast + 1, kLast + 1>;

  void add(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double last, double weight) {
    Eigen::Matrix<double, kLast + 2, 1> row;
    row << first, second, last, 0.0;
    const Eigen::Matrix<double, kLast + 2, 1> weighted = weight * row;
    products_.noalias() += weighted.lazyProduct(row.transpose());
  }

  /// The weighted sum of the products of all rows that were added.
  Matrix sums() const { return products_.topLeftCorner<kLast + 1, kLast + 1>().selfadjointView<Eigen::Lower>(); }
  Matrix6d ofUnknowns() const { return sums().topLeftCorner<kLast, kLast>(); }

private:
  /// Padded with a zero to eight numbers: full registers are faster than half of the products.
  Eigen::Matrix<double, kLast + 2, kLast + 2> products_ = Eigen::Matrix<double, kLast + 2, kLast + 2>::Zero();
};

/// The normal equations of least squares in a small motion, h motion = -g.
struct SmallMotionEquations {
  Matrix6d h = Matrix6d::Zero();  ///< symmetric; its lower half is read
  Vector6d g = Vector6d::Zero();
};

/// The least-squares motion, without motion along unconstrained directions.
/// \param min_stiffness least eigenvalue of a constrained direction, as a share of the greatest eigenvalue of h.
/// \param longest greatest length of the motion; longer ones are scaled down.
inline Vector6d smallMotion(const SmallMotionEquations& equations, double min_stiffness, double longest) {
  Vector6d motion = -SymmetricEigen<Matrix6d>(equations.h).solve(equations.g, min_stiffness);
  const double length = motion.norm();
  return length > longest ? Vector6d(motion * (longest / length)) : motion;
}

inline Eigen::Matrix3d rotationBy(const Eigen::Vector3d& rotation_vector) {
  return Eigen::AngleAxisd(rotation_vector.norm(), rotation_vector.normalized()).toRotationMatrix();
}

inline Eigen::Isometry3d isometry(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Eigen::Isometry3d result(rotation);
  result.translation() = translation;
  return result;
}

inline Eigen::Isometry3d motionBy(const Vector6d& motion) {
  return isometry(rotationBy(motion.head<3>()), motion.tail<3>());
}

/// \return the matrix that multiplies v to x x v.
inline Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& x) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -x.z(), x.y(), x.z(), 0.0, -x.x(), -x.y(), x.x(), 0.0;
  return matrix;
}

/// \return the matrix that maps a small motion (rotation vector, translation) of frame A to that of frame B.
/// \param T_b_a maps points of A to B.
inline Matrix6d adjoint(const Eigen::Isometry3d& T_b_a) {
  Matrix6d adjoint = Matrix6d::Zero();
  adjoint.topLeftCorner<3, 3>() = adjoint.bottomRightCorner<3, 3>() = T_b_a.linear();
  adjoint.bottomLeftCorner<3, 3>() = crossMatrix(T_b_a.translation()) * T_b_a.linear();
  return adjoint;
}

}  // namespace pcl_symmetry
