#include "core/registration/motion_equations.h"

#include <Eigen/Cholesky>

#include "core/registration/pose_covariance.h"
#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

Eigen::Isometry3d MotionEquations::motion() {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  const WeightedProducts::Matrix planes = of_planes_.sums(), points = of_points_.sums();
  const Eigen::Matrix3d arms = points.topLeftCorner<3, 3>(), turned = points.block<3, 3>(0, 3);
  Eigen::Matrix<double, 6, 6> hessian = planes.topLeftCorner<6, 6>();
  hessian.topLeftCorner<3, 3>() += arms.trace() * Eigen::Matrix3d::Identity() - arms;
  hessian.block<3, 3>(3, 0) -= crossMatrix(points.block<3, 1>(0, 6));
  hessian.bottomRightCorner<3, 3>().diagonal().array() += points(6, 6);
  Vector6d gradient = planes.block<6, 1>(0, 6);
  gradient.head<3>() +=
      Eigen::Vector3d(turned(1, 2) - turned(2, 1), turned(2, 0) - turned(0, 2), turned(0, 1) - turned(1, 0));
  gradient.tail<3>() += points.block<3, 1>(3, 6);
  hessian.diagonal().array() += kRegistration.inertia + kRegistration.relative_inertia * hessian.diagonal().maxCoeff();
  const Vector6d motion = hessian.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  if (!motion.allFinite()) return moved;
  const double angle = motion.head<3>().norm();
  if (angle > 0.0) moved.linear() = Eigen::AngleAxisd(angle, motion.head<3>() / angle).toRotationMatrix();
  moved.translation() = unit_ * motion.tail<3>();
  return moved;
}

}  // namespace pcl_symmetry
