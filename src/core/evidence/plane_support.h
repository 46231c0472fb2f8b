#pragma once

#include <vector>

#include "core/neighbours/surface_normals.h"
#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/geometry/reflection_plane.h"
#include "pcl_symmetry/core/scan/visibility.h"

namespace pcl_symmetry {

/// How well single points of a surface support a reflection (the white regions of Figure 8).
///
/// A reflected point that lies on the surface is found at a distance from the nearest sample of it that depends on the
/// density of the samples alone: beyond 1.25 spacings (1 / sqrt(density), measured at that sample) lies 1 in 130. Up to
/// there the support is 1; beyond it falls as a Gaussian. So it needs no threshold in input units.

/// One value in [0, 1] per reflected point each.
struct PointEvidence {
  std::vector<float> support;   ///< its reflection lies on the surface
  std::vector<float> conflict;  ///< its reflection lies where the scanner saw that there is nothing
};

/// At an edge the closest sample may lie on another face: the best of it and the samples next to it counts.
/// \param reflected,reflected_normals 3 x M, of the points. \param closest of each the closest sample of the surface;
/// -1: none is near. \param samples 3 x N, the surface, normalised to the unit ball, \p geometry of it.
/// \param visibility what was seen, in the same frame; null = everything.
PointEvidence pointEvidence(const Points& reflected, const Points& reflected_normals, const std::vector<int>& closest,
                            const Points& samples, const LocalGeometry& geometry, const Visibility* visibility);

/// The support of each sample on the surface that the others describe: what sampling alone makes of a symmetry.
std::vector<float> ownSupport(const Points& samples, const LocalGeometry& geometry);

/// The same from the points: the support of each of \p points on the surface that \p samples describe.
/// \param points 3 x M, finite. \param samples 3 x N, finite, not all equal, in the same frame.
std::vector<float> planeSupport(const PointsRef& points, const PointsRef& samples, const ReflectionPlane& plane,
                                int num_threads = 0);

}  // namespace pcl_symmetry
