#include "core/registration/steps/motion_equations.h"

#include <Eigen/Cholesky>

#include "core/base/simd.h"
#include "core/registration/covariance/pose_covariance.h"

namespace pcl_symmetry {

namespace {

// Inertia, added to the diagonal, relative to its greatest entry and absolute: directions that nothing fixes stay where
// they are. derived: shortens steps along the best fixed direction by 1e-4 of their length.
constexpr double kRelativeInertia = 1e-4, kInertia = 1e-6;
constexpr int kLanes = 8;  // derived: numbers of the widest registers

/// Adds the products of each two columns and a weight, in kLanes partial sums.
/// \param weights,columns \p stride numbers each, of which \p size count, a multiple of kLanes up to \p stride.
/// \param[in,out] weighted as many numbers that are overwritten.
/// \param[in,out] products a matrix by rows, below the diagonal.
PCL_SYMMETRY_MULTIVERSION
void addProducts(const double* __restrict weights, const double* __restrict columns, int num_columns, int stride,
                 int size, double* __restrict weighted, double* __restrict products) {
  for (int a = 0; a < num_columns; ++a) {
    for (int i = 0; i < size; ++i) weighted[i] = weights[i] * columns[a * stride + i];
    for (int b = 0; b <= a; ++b) {
      const double* const other = columns + b * stride;
      double lanes[kLanes] = {};
      for (int i = 0; i < size; i += kLanes)
        for (int k = 0; k < kLanes; ++k) lanes[k] += weighted[i + k] * other[i + k];
      double sum = 0.0;
      for (int k = 0; k < kLanes; ++k) sum += lanes[k];
      products[a * num_columns + b] += sum;
    }
  }
}

}  // namespace

void WeightedProducts::sumUp() {
  const int size = (num_rows_ + kLanes - 1) / kLanes * kLanes;
  for (int i = num_rows_; i < size; ++i) {
    weights_[i] = 0.0;
    for (auto& column : columns_) column[i] = 0.0;
  }
  double weighted[kMostRows];
  addProducts(weights_, columns_[0], kColumns, kMostRows, size, weighted, products_.data());
  num_rows_ = 0;
}

WeightedProducts::Matrix WeightedProducts::sums() {
  sumUp();
  return Matrix(products_.selfadjointView<Eigen::Lower>());
}

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
  hessian.diagonal().array() += kInertia + kRelativeInertia * hessian.diagonal().maxCoeff();
  const Vector6d motion = hessian.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  if (!motion.allFinite()) return moved;
  const double angle = motion.head<3>().norm();
  if (angle > 0.0) moved.linear() = Eigen::AngleAxisd(angle, motion.head<3>() / angle).toRotationMatrix();
  moved.translation() = unit_ * motion.tail<3>();
  return moved;
}

}  // namespace pcl_symmetry
