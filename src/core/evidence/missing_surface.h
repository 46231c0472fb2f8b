#pragma once

#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// How well the end of a cloud explains that a piece of its reflection has no counterpart.
///
/// Not in the paper. Where a piece of an object was cut off, the reflection goes on beyond a plane, and the surface
/// runs into that plane: its normals lie along it. A part that an object has on one side alone has its reflection
/// beyond the surface, too, but there the surface closes: its normals stand on the plane. This needs no open border,
/// and so it also decides for parts as thin as the spacing, whose borders are not found, and for parts that share no
/// edge with what is matched. An end far from the piece, such as the rim of a mug far from its handle, explains
/// nothing.
/// \param cloud 3 x N, N > 0, finite.
/// \param normals 3 x N, unit, of arbitrary sign.
/// \param piece reflections of neighboring points without counterpart.
/// \param spacing median distance of the points.
/// \return in [0, 1]: 1 where the cloud was cut off before the piece, 0 where a counterpart should be there.
float beyondEnd(const Points& cloud, const Points& normals, const Points& piece, double spacing);

/// The samples of a cloud, as points() of NormalizedCloud.
struct SampledSurface {
  const Points& points;              ///< 3 x N, N > 0
  const LocalGeometry& geometry;     ///< of them
  const std::vector<char>& borders;  ///< what openBorders() returned
  double spacing;                    ///< median distance of the points
};

/// How well the end of a cloud explains that a sample has no counterpart under a plane.
///
/// Neighboring samples without counterpart form regions. A region is explained as far as its edge runs along open
/// borders, at the samples themselves or at their reflections, more than by chance: short edges may do so by chance,
/// and so may those of a region all of whose samples lie near borders. It is also explained where its reflection lies
/// beyond the end of the cloud, see beyondEnd().
/// \param matched N values, 1 where the reflection of the sample lies on the surface.
/// \param closest N indices of the samples closest to the reflections; -1: none is near.
/// \param reflected 3 x N, the reflections.
/// \return N values in [0, 1]: 0 for samples that have a counterpart or should have one, 1 where it is missing from the
/// cloud.
std::vector<float> missingCounterparts(const SampledSurface& surface, const std::vector<char>& matched,
                                       const std::vector<int>& closest, const Points& reflected);

/// Where a cloud ends although the object may go on: at open borders, and where its surface runs into its end.
///
/// Beyond the paper, which has whole shapes. For a true plane the points without a counterpart begin where the cloud,
/// or its reflection, ends; for a false one they begin in the middle of the surface.
struct SurfaceEnds {
  std::vector<char> borders;  ///< what openBorders() returned
  double trust;  ///< how far open borders may excuse missing counterparts, in [0, 1]: 0 for a wire or an open sheet

  /// \param found the neighbors of the points.
  SurfaceEnds(const Points& points, const LocalGeometry& geometry, const ClosestPointSearch& search,
              const FoundNeighbors& found, int num_threads);
};

}  // namespace pcl_symmetry
