#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/surface_segmentation.h"

namespace pcl_symmetry {

/// The planes of a part of a surface and how much each element of the part contributes to them (Section 5.3).
struct SymmetryFeatures {
  std::vector<PartPlane> planes;  ///< significant maxima of the transform, strongest first
  Eigen::MatrixXf support;        ///< planes x elements, in [0, 1]: f at the reflections of the elements
  double radius = 0.0;            ///< radius of the part, input units
};

/// Finds the significant maxima of the transform of a part (Section 4.4) and the support of every element for them
/// ("how well does the face map onto the surface after reflection across the plane", Section 5.3).
/// \param elements elements of the part, with an area > 0.
/// \param seed seed of the samples of the part, in place of the seed in the options.
SymmetryFeatures symmetryFeatures(const SurfaceGraph& graph, const std::vector<int>& elements,
                                  const SegmentationOptions& options, std::uint64_t seed);

}  // namespace pcl_symmetry
