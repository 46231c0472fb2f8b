#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/point_set.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Options of localSymmetry().
struct LocalSymmetryOptions {
  double scale = 0.0;        ///< radius of the window around each point, input units, > 0
  int num_directions = 256;  ///< number of planes through each point, >= 1; with 256, their normals are 9 degrees apart
  int num_samples = 256;     ///< number of points drawn from each window, >= 1
  std::uint64_t seed = 1;    ///< seed of the points drawn
  int num_threads = 0;       ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The transform at a scale (Section 6: "computed on local sections of the model"): for each point, the greatest D of a
/// plane through it, with f weighted by a window around the point, w(x) = (1 - |x - p|^2 / scale^2)^2. The window
/// equals its own reflection, so that D = sum w^2 f(x) f(gamma x) / sum w^2 f(x)^2. It is estimated from points drawn
/// from the window.
/// \param points 3 x N, finite, input frame.
/// \return one value per point, about [0, 1]; 0 where the window is empty.
/// \throws std::invalid_argument for bad options.
std::vector<float> localSymmetry(const GaussianEdt& edt, const PointsRef& points, const LocalSymmetryOptions& options);

}  // namespace pcl_symmetry
