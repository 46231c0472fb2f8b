#pragma once

#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// How well single points of a surface support a reflection (the white regions of Figure 8).
///
/// A reflected point that lies on the surface is found at a distance from the nearest sample of it that depends on the
/// density of the samples alone: beyond 1.25 spacings (1 / sqrt(density), measured at that sample) lies 1 in 130. Up to
/// there the support is 1; beyond it falls as a Gaussian. So it needs no threshold in input units.

/// \param closest,sq_distances for each reflected point the closest sample and its squared distance.
/// \param spacing of every sample, in the units of the distances.
/// \return one value in [0, 1] per reflected point.
std::vector<float> pointSupport(const std::vector<int>& closest, const std::vector<float>& sq_distances,
                                const std::vector<float>& spacing);

/// The same from the points: the support of each of \p points on the surface that \p samples describe.
/// \param points 3 x M, finite. \param samples 3 x N, finite, not all equal, in the same frame.
std::vector<float> planeSupport(const PointsRef& points, const PointsRef& samples, const ReflectionPlane& plane,
                                int num_threads = 0);

}  // namespace pcl_symmetry
