#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/segmentation/surface_segmentation.h"

namespace pcl_symmetry {

/// Planes of a part of a surface, and what each element of the part contributes to them.
struct SymmetryFeatures {
  std::vector<PartPlane> planes;  ///< strongest first
  Eigen::MatrixXf support;        ///< planes x elements, in [0, 1]: f at the reflection of the element
};

/// Points spread over elements by area.
Points sampleElements(const SurfaceGraph& graph, const std::vector<int>& elements, int num_points, std::uint64_t seed);

/// Significant maxima of the transform of a part, refined, with the support of every element (Sections 4.4 and 5.3).
SymmetryFeatures symmetryFeatures(const SurfaceGraph& graph, const std::vector<int>& elements,
                                  const SplittingOptions& options, std::uint64_t seed, int num_threads);

/// Splits a part in two by its symmetries: two-means of the support, the two largest connected components, and the
/// minimum cut between them.
/// \return the elements of both sides; nothing where the part cannot be split.
std::optional<std::pair<std::vector<int>, std::vector<int>>> splitBySymmetry(const SurfaceGraph& graph,
                                                                             const std::vector<int>& elements,
                                                                             const SymmetryFeatures& features,
                                                                             const SplittingOptions& options,
                                                                             std::uint64_t seed);

}  // namespace pcl_symmetry
