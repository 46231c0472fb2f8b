#pragma once

#include <Eigen/Core>

namespace pcl_symmetry {

/// The weighted sum of x x^T over rows x of seven numbers, many rows at a time. It is the same for every instruction
/// set.
class WeightedProducts {
public:
  static constexpr int num_columns = 7;  // six unknowns and a right side
  using Matrix = Eigen::Matrix<double, num_columns, num_columns, Eigen::RowMajor>;

  void add(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double last, double weight) {
    for (int k = 0; k < 3; ++k) {
      columns_[k][num_rows_] = first[k];
      columns_[k + 3][num_rows_] = second[k];
    }
    columns_[num_columns - 1][num_rows_] = last;
    weights_[num_rows_] = weight;
    if (++num_rows_ == most_rows) sumUp();
  }

  /// Of all rows that were added.
  Matrix sums();

private:
  static constexpr int most_rows = 128;  // the columns fit the first cache

  void sumUp();

  double columns_[num_columns][most_rows], weights_[most_rows];
  int num_rows_ = 0;                  // that are not in the products yet
  Matrix products_ = Matrix::Zero();  // below the diagonal
};

}  // namespace pcl_symmetry
