/// Gauss-Newton steps of small motions: a rotation vector omega, radians, then a translation t, which move x to
/// x + omega x x + t.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace pcl_symmetry {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The motion of least squares, -h^-1 g. Directions that nothing fixes stay as they are.
/// \param h symmetric; its lower half is read.
/// \param least_stiffness of a direction that is fixed, share of the greatest eigenvalue of \p h.
/// \param longest a longer motion is cut to this length.
inline Vector6d smallMotion(const Matrix6d& h, const Vector6d& g, double least_stiffness, double longest) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(h);
  Vector6d motion = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const double stiffness = solver.eigenvalues()[i];
    if (!(stiffness > least_stiffness * solver.eigenvalues()[5])) continue;
    motion -= solver.eigenvectors().col(i) * (solver.eigenvectors().col(i).dot(g) / stiffness);
  }
  const double length = motion.norm();
  return length > longest ? Vector6d(motion * (longest / length)) : motion;
}

inline Eigen::Matrix3d rotationBy(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

}  // namespace pcl_symmetry
