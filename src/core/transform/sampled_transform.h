#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/gaussian_edt.h"
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

/// Draws points with probability f: a cell by its value of f, then a uniform position in the cell.
///
/// Stratified: one point falls in each of num_samples equal shares of the sum of f along a space-filling curve, so that
/// the points are spread evenly over the surface.
/// \return 3 x num_samples, in cells from the center of cell (0, 0, 0).
Eigen::Matrix3Xf drawPoints(const GaussianEdt& edt, int num_samples, std::uint64_t seed, int num_threads);

}  // namespace pcl_symmetry
