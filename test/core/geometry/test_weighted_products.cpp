/// Sums of weighted products of many rows, against those of single rows.
#include "core/geometry/weighted_products.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace {

using namespace pcl_symmetry;

TEST(WeightedProducts, AreThoseOfTheirRows) {
  RandomStream random(1);
  const auto draw = [&] { return random.uniform() - 0.5; };
  for (const int num_rows : {0, 1, 7, 8, 128, 129, 1000}) {
    WeightedProducts products;
    WeightedProducts::Matrix expected = WeightedProducts::Matrix::Zero();
    for (int i = 0; i < num_rows; ++i) {
      const Eigen::Vector3d first(draw(), draw(), draw()), second(draw(), draw(), draw());
      const double last = draw(), weight = random.uniform();
      products.add(first, second, last, weight);
      Eigen::Matrix<double, WeightedProducts::kColumns, 1> row;
      row << first, second, last;
      expected += weight * row * row.transpose();
    }
    // Sums of 1000 numbers up to 1 / 4 in another order differ by 1000 roundings of 30 at most.
    EXPECT_LT((products.sums() - expected).cwiseAbs().maxCoeff(), 1e-11) << num_rows;
    EXPECT_LT((products.sums() - expected).cwiseAbs().maxCoeff(), 1e-11) << num_rows << ", asked again";
  }
}

}  // namespace
