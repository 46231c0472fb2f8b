#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"

namespace pcl_symmetry {

/// Points of the EDT in cells from its first cell center: a cell drawn by f, then a uniform place in it. One point
/// falls in each of num_samples equal shares of sum f along a space-filling curve, so that the points are spread
/// evenly.
Eigen::Matrix3Xf drawPoints(const GaussianEdt& edt, int num_samples, std::uint64_t seed, int num_threads);

}  // namespace pcl_symmetry
