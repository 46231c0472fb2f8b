#include "core/transform/filled_slabs.h"

#include <algorithm>

namespace pcl_symmetry {

namespace {

constexpr float slab_slack = 0.01f;  // cells; more than fixed-point steps and floats are rounded by

}  // namespace

SlabsOfCells::SlabsOfCells(const GaussianEdt& edt) {
  // The directions from a cell to its neighbors, one of each pair.
  for (int code = 14; code < 27; ++code)
    axes.row(code - 14) << static_cast<float>(code % 3 - 1), static_cast<float>(code / 3 % 3 - 1),
        static_cast<float>(code / 9 - 1);
  constexpr float far = 1e6f;  // farther than every cell
  low.setConstant(far);
  high.setConstant(-far);
  const int n = edt.numCells();
  for (int row = 0; row < n * n; ++row) {
    const GaussianEdt::Range filled = edt.filledRanges()[static_cast<std::size_t>(row)];
    if (filled.begin == filled.end) continue;
    for (const int x : {filled.begin, filled.end - 1}) {
      const Eigen::Matrix<float, kMostSlabs, 1> along =
          axes * Eigen::Vector3f(static_cast<float>(x), static_cast<float>(row % n), static_cast<float>(row / n));
      low = low.cwiseMin(along);
      high = high.cwiseMax(along);
    }
  }
  // A look-up takes the whole cell.
  const Eigen::Matrix<float, kMostSlabs, 1> of_cell = 0.5f * axes.cwiseAbs().rowwise().sum().array() + slab_slack;
  low -= of_cell;
  high += of_cell;
}

FilledSlabs::FilledSlabs(const GaussianEdt& edt,
                         const Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::RowMajor>& samples) {
  const SlabsOfCells slabs(edt);
  axes_ = slabs.axes.transpose();
  const Eigen::MatrixXf along = samples.transpose() * axes_;
  low_ = (-along).rowwise() + slabs.low.transpose();
  high_ = (-along).rowwise() + slabs.high.transpose();
}

}  // namespace pcl_symmetry
