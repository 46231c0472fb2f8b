/// Eigenvectors of symmetric matrices and systems of equations with them, by Eigen. They are compiled once, in
/// symmetric_solvers.cpp, which lists the matrices: a source that names Eigen's solvers takes twice as long to compile.
/// Also Gauss-Newton steps of small motions: a rotation vector omega, radians, then a translation t, which move x to x
/// + omega x x + t.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

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
  /// Products of eight numbers, the last of which is 0: full registers are quicker than half of the products.
  Eigen::Matrix<double, kLast + 2, kLast + 2> products_ = Eigen::Matrix<double, kLast + 2, kLast + 2>::Zero();
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

}  // namespace pcl_symmetry
