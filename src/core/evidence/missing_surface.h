#pragma once

#include <vector>

#include "core/evidence/outermost_points.h"
#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Where a cloud ends although the object goes on: a cut, a hole, a side that no scan saw.
///
/// Beyond the paper, which has whole shapes. For a true plane the points without a counterpart begin where the cloud,
/// or its reflection, ends; for a false one they begin in the middle of the surface.

/// The samples of a cloud, as points() of NormalizedCloud.
struct SampledSurface {
  const OutermostPoints& points;     ///< N
  const LocalGeometry& geometry;     ///< of them
  const std::vector<char>& borders;  ///< what openBorders() returned
  double spacing;                    ///< median distance of the points
};

/// How well the end of a cloud explains that a sample has no counterpart under a plane.
///
/// Neighbouring samples without counterpart form regions. A region is explained as far as its edge runs along open
/// borders, at the samples themselves or at their reflections, more than chance would have it: short edges may do so by
/// chance, and so may those of a region all of whose samples lie near borders. Or its reflection lies beyond the end of
/// the cloud, see beyondEnd().
/// \param matched N values, 1 where the reflection of the sample lies on the surface.
/// \param closest N indices of the samples closest to the reflections; -1: none is near.
/// \param reflected 3 x N, the reflections.
/// \return N values in [0, 1]: 0 for samples that have a counterpart or should have one, 1 where it is missing from the
/// cloud.
std::vector<float> missingCounterparts(const SampledSurface& surface, const std::vector<char>& matched,
                                       const std::vector<int>& closest, const Points& reflected);

}  // namespace pcl_symmetry
