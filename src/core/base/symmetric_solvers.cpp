#include "core/base/symmetric_solvers.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <type_traits>

namespace pcl_symmetry {

namespace {

/// Matrices of three rows have specialized code; all others share the code for any size.
template <typename Matrix>
using Compiled = std::conditional_t<Matrix::RowsAtCompileTime == 3, Matrix, Eigen::MatrixXd>;

}  // namespace

template <typename Matrix>
SymmetricEigen<Matrix>::SymmetricEigen(const Matrix& matrix) {
  Eigen::SelfAdjointEigenSolver<Compiled<Matrix>> solver;
  if constexpr (std::is_same_v<Matrix, Eigen::Matrix3f>)
    solver.computeDirect(matrix);
  else
    solver.compute(Compiled<Matrix>(matrix));
  eigenvalues_ = solver.eigenvalues();
  eigenvectors_ = solver.eigenvectors();
}

template <typename Matrix>
typename SymmetricEigen<Matrix>::Vector SymmetricEigen<Matrix>::solve(const Vector& b,
                                                                      double min_relative_eigenvalue) const {
  Vector x = Vector::Zero(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) {
    if (!(eigenvalues_[i] > min_relative_eigenvalue * eigenvalues_[b.size() - 1])) continue;
    x += eigenvectors_.col(i) * (eigenvectors_.col(i).dot(b) / eigenvalues_[i]);
  }
  return x;
}

template class SymmetricEigen<Eigen::Matrix3f>;
template class SymmetricEigen<Eigen::Matrix2d>;
template class SymmetricEigen<Eigen::Matrix3d>;
template class SymmetricEigen<Eigen::Matrix4d>;
template class SymmetricEigen<Matrix6d>;
template class SymmetricEigen<Eigen::MatrixXd>;

template <typename Scalar, int size, int columns>
Eigen::Matrix<Scalar, size, columns> solveSymmetric(const Eigen::Matrix<Scalar, size, size>& a,
                                                    const Eigen::Matrix<Scalar, size, columns>& b) {
  if constexpr (size == 3)
    return a.ldlt().solve(b);
  else
    return Eigen::MatrixXd(a).ldlt().solve(Eigen::VectorXd(b));
}

template Eigen::Vector3f solveSymmetric(const Eigen::Matrix3f&, const Eigen::Vector3f&);
template Eigen::Vector2d solveSymmetric(const Eigen::Matrix2d&, const Eigen::Vector2d&);
template Eigen::Vector3d solveSymmetric(const Eigen::Matrix3d&, const Eigen::Vector3d&);
template Eigen::Matrix3d solveSymmetric(const Eigen::Matrix3d&, const Eigen::Matrix3d&);
template Eigen::Vector4d solveSymmetric(const Eigen::Matrix4d&, const Eigen::Vector4d&);
template Vector6d solveSymmetric(const Matrix6d&, const Vector6d&);

Eigen::MatrixXd orthonormalColumns(const Eigen::MatrixXd& spanning) {
  return Eigen::HouseholderQR<Eigen::MatrixXd>(spanning).householderQ() *
         Eigen::MatrixXd::Identity(spanning.rows(), spanning.cols());
}

}  // namespace pcl_symmetry
