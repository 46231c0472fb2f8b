#pragma once

#include <Eigen/Core>

namespace pcl_symmetry {

/// The weighted sum of x x^T over rows x of seven numbers, many rows at a time. It is the same for every instruction
/// set.
class WeightedProducts {
public:
  static constexpr int kColumns = 7;  // derived: six unknowns and a right side
  using Matrix = Eigen::Matrix<double, kColumns, kColumns, Eigen::RowMajor>;

  void add(const Eigen::Vector3d& first, const Eigen::Vector3d& second, double last, double weight) {
    for (int k = 0; k < 3; ++k) {
      columns_[k][num_rows_] = first[k];
      columns_[k + 3][num_rows_] = second[k];
    }
    columns_[kColumns - 1][num_rows_] = last;
    weights_[num_rows_] = weight;
    if (++num_rows_ == kMostRows) sumUp();
  }

  /// Of all rows that were added.
  Matrix sums();

private:
  static constexpr int kMostRows = 128;  // chosen: the columns fit the first cache; half calls twice as often

  void sumUp();

  double columns_[kColumns][kMostRows], weights_[kMostRows];
  int num_rows_ = 0;                  // that are not in the products yet
  Matrix products_ = Matrix::Zero();  // below the diagonal
};

}  // namespace pcl_symmetry
