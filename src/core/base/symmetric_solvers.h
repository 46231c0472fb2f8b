/// Eigenvectors of symmetric matrices and systems of equations with them, by Eigen. Instantiated once, in
/// symmetric_solvers.cpp, for the matrices listed there: including Eigen's solvers doubles the compile time of a
/// source.
#pragma once

#include <Eigen/Core>

namespace pcl_symmetry {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Eigenvalues, smallest first, and unit eigenvectors in the same order. Reads the lower half of a matrix.
/// Floats take the roots of the characteristic polynomial, which is quick and loses some digits.
template <typename Matrix>
class SymmetricEigen {
public:
  using Vector = Eigen::Matrix<typename Matrix::Scalar, Matrix::RowsAtCompileTime, 1>;

  explicit SymmetricEigen(const Matrix& matrix);

  const Vector& eigenvalues() const { return eigenvalues_; }
  const Matrix& eigenvectors() const { return eigenvectors_; }

  /// Solves matrix x = b, ignoring directions whose eigenvalue is at most \p min_relative_eigenvalue times the
  /// greatest.
  Vector solve(const Vector& b, double min_relative_eigenvalue) const;

private:
  Vector eigenvalues_;
  Matrix eigenvectors_;
};

/// Solves a x = b by the LDL^T decomposition of \p a, which is symmetric and positive semidefinite.
template <typename Scalar, int size, int columns>
Eigen::Matrix<Scalar, size, columns> solveSymmetric(const Eigen::Matrix<Scalar, size, size>& a,
                                                    const Eigen::Matrix<Scalar, size, columns>& b);

/// An orthonormal basis of the column space of \p spanning, by QR decomposition.
/// \param spanning at least as many rows as columns.
Eigen::MatrixXd orthonormalColumns(const Eigen::MatrixXd& spanning);

}  // namespace pcl_symmetry
