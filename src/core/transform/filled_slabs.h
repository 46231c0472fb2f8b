#pragma once

#include <vector>

#include "core/transform/line_kernel.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

/// Slabs around the cells in which f is not 0, along the thirteen directions to the neighbors of a cell:
/// low <= axes . p <= high for all p in one of them, in cells from the center of cell (0, 0, 0). Most shapes fill a
/// small part of their ball.
struct SlabsOfCells {
  explicit SlabsOfCells(const GaussianEdt& edt);

  Eigen::Matrix<float, kMostSlabs, 3> axes;
  Eigen::Matrix<float, kMostSlabs, 1> low, high;
};

/// The same as samples see them: their images beyond a slab need no look-up.
class FilledSlabs {
public:
  /// \param samples 3 x N, in cells from the center of cell (0, 0, 0).
  FilledSlabs(const GaussianEdt& edt, const Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::RowMajor>& samples);

  /// As the samples from one on see them.
  SlabsOfSamples from(Eigen::Index first) const {
    return {axes_.data(), low_.data() + first, high_.data() + first, low_.rows(), static_cast<int>(axes_.cols())};
  }

private:
  Eigen::Matrix3Xf axes_;
  Eigen::MatrixXf low_, high_;  ///< a row for each sample
};

}  // namespace pcl_symmetry
