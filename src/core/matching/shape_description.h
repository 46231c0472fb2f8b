#pragma once

#include <cstdint>

#include "core/descriptors/shape_signature.h"
#include "pcl_symmetry/core/scan/visibility.h"

namespace pcl_symmetry {

struct DescriptionOptions {
  int max_points = 20'000;       ///< that signatures are made of, spread over those given, >= 2
  int max_frame_points = 4'096;  ///< and the frame, >= 2
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< >= 0; 0 = one per core

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// What is known of a shape to find it, or one of its kind, among others.
struct ShapeDescription {
  SymmetryFrame frame;
  Eigen::MatrixXf signatures;  ///< kSignatureSize x 2: in each of the signatureFrames()
};

/// \param points 3 x N, finite, input units; at least two different ones.
/// \param visibility what a scanner saw; null = the points show the object from all sides.
/// \throws std::invalid_argument for bad options or points without extent.
ShapeDescription describeShape(const PointsRef& points, const DescriptionOptions& options = {},
                               const Visibility* visibility = nullptr);

}  // namespace pcl_symmetry
