#pragma once

#include <vector>

#include "core/normals/surface_normals.h"
#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// Radius of the disc of surface that a sample stands for, spacings.
/// derived: a disc of that radius on a surface of density rho holds no sample with probability exp(-pi 1.25^2) = 1 /
/// 135.
constexpr float kDiscRadius = 1.25f;

/// How far points lie from the surface that samples describe. Each sample stands for a disc in its tangent plane; the
/// disc of the closest sample or of one of its four neighbours counts, whichever is nearest.
/// \param points 3 x M, in the frame of the samples.
/// \param closest M indices of the closest samples; -1: none is near.
/// \param samples 3 x N.
/// \param geometry of the samples.
/// \return M distances >= 0, units of the samples; infinity where no sample is near.
std::vector<float> surfaceDistances(const Points& points, const std::vector<int>& closest, const Points& samples,
                                    const LocalGeometry& geometry);

/// Distance of each sample from the surface that the others describe: what sampling and noise alone make of a surface
/// that is mapped onto itself.
/// \param samples 3 x N, N >= 2.
/// \param geometry of the samples.
/// \return N distances >= 0, units of the samples.
std::vector<float> ownSurfaceDistances(const Points& samples, const LocalGeometry& geometry);

/// \param distances at least one.
/// \return share of the distances that are at most \p tolerance, in [0, 1].
double shareWithin(const std::vector<float>& distances, double tolerance);

}  // namespace pcl_symmetry
