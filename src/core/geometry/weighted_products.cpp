#include "core/geometry/weighted_products.h"

#include "core/base/simd.h"

namespace pcl_symmetry {

namespace {

constexpr int num_lanes = 8;  // numbers of the widest registers

/// Adds the products of each two columns and a weight, in num_lanes partial sums.
/// \param weights,columns \p stride numbers each, of which \p size count, a multiple of num_lanes up to \p stride.
/// \param[in,out] weighted as many numbers that are overwritten.
/// \param[in,out] products a matrix by rows, below the diagonal.
PCL_SYMMETRY_MULTIVERSION
void addProducts(const double* __restrict weights, const double* __restrict columns, int num_columns, int stride,
                 int size, double* __restrict weighted, double* __restrict products) {
  for (int a = 0; a < num_columns; ++a) {
    for (int i = 0; i < size; ++i) weighted[i] = weights[i] * columns[a * stride + i];
    for (int b = 0; b <= a; ++b) {
      const double* const other = columns + b * stride;
      double lanes[num_lanes] = {};
      for (int i = 0; i < size; i += num_lanes)
        for (int k = 0; k < num_lanes; ++k) lanes[k] += weighted[i + k] * other[i + k];
      double sum = 0.0;
      for (int k = 0; k < num_lanes; ++k) sum += lanes[k];
      products[a * num_columns + b] += sum;
    }
  }
}

}  // namespace

void WeightedProducts::sumUp() {
  const int size = (num_rows_ + num_lanes - 1) / num_lanes * num_lanes;
  for (int i = num_rows_; i < size; ++i) {
    weights_[i] = 0.0;
    for (auto& column : columns_) column[i] = 0.0;
  }
  double weighted[most_rows];
  addProducts(weights_, columns_[0], num_columns, most_rows, size, weighted, products_.data());
  num_rows_ = 0;
}

WeightedProducts::Matrix WeightedProducts::sums() {
  sumUp();
  return Matrix(products_.selfadjointView<Eigen::Lower>());
}

}  // namespace pcl_symmetry
