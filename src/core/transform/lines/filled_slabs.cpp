#include "core/transform/lines/filled_slabs.h"

#include <algorithm>

namespace pcl_symmetry {

namespace {

// Cells. derived: more than what fixed-point steps add up to, 64 times 2^-17, and what floats about 64 are rounded by.
constexpr float kSlack = 0.01f;

/// The directions from a cell to its neighbours, one of each pair.
Eigen::Matrix3Xf directionsToNeighbours() {
  Eigen::Matrix3Xf axes(3, kMostSlabs);
  int count = 0;
  for (int code = 14; code < 27; ++code)
    axes.col(count++) = Eigen::Vector3f(static_cast<float>(code % 3 - 1), static_cast<float>(code / 3 % 3 - 1),
                                        static_cast<float>(code / 9 - 1));
  return axes;
}

}  // namespace

FilledSlabs::FilledSlabs(const GaussianEdt& edt,
                         const Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::RowMajor>& samples)
    : axes_(directionsToNeighbours()) {
  constexpr float kFar = 1e6f;  // derived: farther than every cell
  using OfAxes = Eigen::Matrix<float, kMostSlabs, 1>;
  const Eigen::Matrix<float, kMostSlabs, 3> axes = axes_.transpose();
  OfAxes low = OfAxes::Constant(kFar), high = -low;
  const int n = edt.numCells();
  for (int row = 0; row < n * n; ++row) {
    const GaussianEdt::Range filled = edt.filledRanges()[static_cast<std::size_t>(row)];
    if (filled.begin == filled.end) continue;
    for (const int x : {filled.begin, filled.end - 1}) {
      const OfAxes along =
          axes * Eigen::Vector3f(static_cast<float>(x), static_cast<float>(row % n), static_cast<float>(row / n));
      low = low.cwiseMin(along);
      high = high.cwiseMax(along);
    }
  }
  // A look-up takes the whole cell.
  const OfAxes of_cell = 0.5f * axes_.cwiseAbs().colwise().sum().transpose().array() + kSlack;
  const Eigen::MatrixXf along = samples.transpose() * axes_;
  low_ = (-along).rowwise() + (low - of_cell).transpose();
  high_ = (-along).rowwise() + (high + of_cell).transpose();
}

}  // namespace pcl_symmetry
