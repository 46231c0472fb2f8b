#pragma once

#include <cstdint>

#include "core/matching/shape_signature.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

struct DescriptionOptions {
  /// Points that signatures are made of, spread evenly over the input, >= 2. chosen: time grows with them; half leaves
  /// holes in the fine cells of large surfaces.
  int max_points = 20'000;
  /// Points that the symmetry frame is made of, >= 2. chosen: time grows with them; half makes axes less exact.
  int max_frame_points = 4'096;
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// A shape as matching sees it: the same in all poses and sizes (Section 5.2).
struct ShapeDescription {
  SymmetryFrame frame;
  Eigen::MatrixXf signatures;  ///< kSignatureSize x 2, one column for each of the signatureFrames()
};

/// \param points 3 x N, finite, input units, at least two different ones.
/// \param visibility what a scanner saw; null = the points show the object from all sides.
/// \throws std::invalid_argument for bad options or points without extent.
ShapeDescription describeShape(const PointsRef& points, const DescriptionOptions& options = {},
                               const Visibility* visibility = nullptr);

}  // namespace pcl_symmetry
