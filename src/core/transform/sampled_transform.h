#pragma once

#include <vector>

#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

/// The estimate of sampledTransform() for the free space of a scan, which speaks against a plane:
/// F = (S / |f|^2) mean free(gamma x_i).
/// \param free_space one value in [0, 1] per cell of the EDT, as from freeSpace().
/// \return F at the bin centers of the grid, >= 0.
/// \throws std::invalid_argument for bad options or free space of another grid.
std::vector<float> freeOverlap(const GaussianEdt& edt, const PlaneGrid& grid, const std::vector<float>& free_space,
                               const SampledTransformOptions& options = {});

/// Replaces every D of the map by seenSymmetry(D, F).
/// \param free_overlap F at the bin centers of the map's grid.
void weighSeen(SymmetryMap& map, const std::vector<float>& free_overlap);

}  // namespace pcl_symmetry
