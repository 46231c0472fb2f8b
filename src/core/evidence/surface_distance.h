#pragma once

#include <vector>

#include "core/evidence/surface_samples.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// How far points lie from the surface that samples describe. Each sample stands for a disc in its tangent plane; the
/// disc of the closest sample or of one of its four neighbours counts, whichever is nearest.
/// \param points 3 x M, in the frame of the samples.
/// \param closest M indices of the closest samples; -1: none is near.
/// \param samples N of them.
/// \return M distances >= 0, units of the samples; infinity where no sample is near.
std::vector<float> surfaceDistances(const Points& points, const std::vector<int>& closest,
                                    const SurfaceSamples& samples);

/// Distance of each sample from the surface that the others describe: what sampling and noise alone make of a surface
/// that is mapped onto itself.
/// \param samples N >= 2 of them.
/// \param num_threads 0 = one per core.
/// \return N distances >= 0, units of the samples.
std::vector<float> ownSurfaceDistances(const SurfaceSamples& samples, int num_threads = 1);

/// \param distances at least one.
/// \return share of the distances that are at most \p tolerance, in [0, 1].
double shareWithin(const std::vector<float>& distances, double tolerance);

}  // namespace pcl_symmetry
