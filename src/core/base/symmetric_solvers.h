/// Eigenvectors of symmetric matrices and systems of equations with them, by Eigen. They are compiled once, in
/// symmetric_solvers.cpp, which lists the matrices: a source that names Eigen's solvers takes twice as long to compile.
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

  /// x of matrix x = b, without the directions whose eigenvalue is not above \p least times the greatest.
  Vector solve(const Vector& b, double least) const;

private:
  Vector eigenvalues_;
  Matrix eigenvectors_;
};

/// x of a x = b, by the LDL^T of \p a, which is symmetric and has no negative eigenvalue.
template <typename Scalar, int size, int columns>
Eigen::Matrix<Scalar, size, columns> solveSymmetric(const Eigen::Matrix<Scalar, size, size>& a,
                                                    const Eigen::Matrix<Scalar, size, columns>& b);

/// An orthonormal basis of what the columns of \p spanning span, by its QR factors.
/// \param spanning at least as many rows as columns.
Eigen::MatrixXd orthonormalColumns(const Eigen::MatrixXd& spanning);

}  // namespace pcl_symmetry
