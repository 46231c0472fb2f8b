#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/segmentation/symmetry_features.h"

namespace pcl_symmetry {

/// The elements of both sides of a split.
struct SplitPart {
  std::vector<int> first, second;
};

/// Splits a part in two by its symmetries (Section 5.3): k-means with k = 2 on the support, the two largest connected
/// components, and the minimum cut between them.
/// \param graph the whole surface.
/// \param elements those of the part.
/// \param features of the part, one column of support per element.
/// \param options band and costs of the cut.
/// \param seed of k-means.
/// \return both sides; nothing if all elements have the same support or one side is empty.
std::optional<SplitPart> splitByTwoMeans(const SurfaceGraph& graph, const std::vector<int>& elements,
                                         const SymmetryFeatures& features, const SplittingOptions& options,
                                         std::uint64_t seed);

}  // namespace pcl_symmetry
