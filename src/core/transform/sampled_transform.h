#pragma once

#include <vector>

#include "pcl_symmetry/core/transform/planar_transform.h"

namespace pcl_symmetry {

/// The same mean over the free space of a scan: F = (S / |f|^2) mean free(gamma x_i) at the bin centers, >= 0.
std::vector<float> freeOverlap(const GaussianEdt& edt, const PlaneGrid& grid, const std::vector<float>& free_space,
                               const SampledTransformOptions& options = {});

/// Makes seenSymmetry(D, F) of every D in the map.
void weighSeen(SymmetryMap& map, const std::vector<float>& free_overlap);

}  // namespace pcl_symmetry
