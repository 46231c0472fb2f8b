#pragma once

#include <vector>

#include "core/evidence/surface_samples.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Evidence of each of M reflected points, in [0, 1].
struct PointEvidence {
  std::vector<float> support;   ///< the reflection lies on the surface
  std::vector<float> conflict;  ///< the reflection lies where the scanner saw that there is nothing
};

/// How surely a point lies in free space. A pixel without a depth means free space where the sensor is exact, and
/// little where it has errors: it may be a shadow of the projector, or an occluder may have been cut out of the
/// picture.
/// \param x in the unit ball.
/// \return in [0, 1]: 0 behind what was seen, 1 before it.
float emptiness(const Visibility& visibility, const Eigen::Vector3d& x);

/// How well single points of a surface support a reflection (the white regions of Figure 8). Near an edge the closest
/// sample may lie on another face: the best of that sample and of those next to it counts.
///
/// Departure from the paper, which measures the distance of the reflected point by the Gaussian of the transform: here
/// the unit is the distance between samples, so that the result needs no length in input units. A reflected point that
/// lies on the surface is farther from the closest sample than 1.25 spacings in 1 of 135 cases (spacing = 1 /
/// sqrt(density), measured at that sample). Up to there the support is 1; beyond, it falls as a Gaussian.
/// \param reflected 3 x M, reflections of points of the surface, normalized to the unit ball.
/// \param reflected_normals 3 x M, reflections of their normals.
/// \param closest M indices of the closest samples; -1: none is near.
/// \param samples the surface, in the same frame.
/// \param visibility what a scanner saw, in the same frame; null = the samples show the object from all sides.
PointEvidence pointEvidence(const Points& reflected, const Points& reflected_normals, const std::vector<int>& closest,
                            const SurfaceSamples& samples, const Visibility* visibility);

/// Support of each sample on the surface that the other samples describe: what sampling alone leaves of a symmetry.
/// \param samples N, normalized to the unit ball.
/// \return N values in [0, 1].
std::vector<float> ownSupport(const SurfaceSamples& samples, int num_threads);

/// \param support at least one value.
/// \return the mean.
double meanSupport(const std::vector<float>& support);

/// Support of each of \p points for planes, on the surface that \p samples describe.
/// \param points 3 x M, finite.
/// \param samples 3 x N, finite, not all equal, in the same frame.
/// \param planes in the same frame.
/// \return for each plane M values in [0, 1].
/// \throws std::invalid_argument where all samples coincide.
std::vector<std::vector<float>> planeSupport(const PointsRef& points, const PointsRef& samples,
                                             const std::vector<ReflectionPlane>& planes, int num_threads = 0);

}  // namespace pcl_symmetry
