#pragma once

#include <Eigen/Core>

namespace pcl_symmetry {

/// The weighted sum of x x^T over rows x of seven numbers: six unknowns and a right side.
class WeightedProducts {
public:
  using Matrix = Eigen::Matrix<double, 7, 7>;

  void add(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double last, double weight) {
    Eigen::Matrix<double, 7, 1> row;
    row << first, second, last;
    sums_.noalias() += weight * row * row.transpose();
  }

  /// The weighted sum of the products of all rows that were added.
  const Matrix& sums() const { return sums_; }

private:
  Matrix sums_ = Matrix::Zero();
};

}  // namespace pcl_symmetry
