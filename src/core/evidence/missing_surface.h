#pragma once

#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// How well the end of a cloud explains that a piece of its reflection has no counterpart. Not in the paper.
///
/// Where a piece of an object was cut off along a plane, the reflection continues beyond that plane and the surface
/// runs into it: its normals are parallel to it. The reflection of a part that exists on one side only also lies beyond
/// the surface, but there the surface closes: its normals are perpendicular to the plane. This requires no open border.
/// It therefore also decides on parts as thin as the spacing, whose borders are not found, and on parts that share no
/// edge with the matched surface. An end far from the piece, such as the rim of a mug far from its handle, explains
/// nothing.
/// \param cloud 3 x N, N > 0, finite.
/// \param normals 3 x N, unit, of arbitrary sign.
/// \param piece reflections of neighboring points that have no counterpart.
/// \param spacing median distance of the points.
/// \return in [0, 1]: 1 where the cloud was cut off before the piece, 0 where a counterpart should be there.
float beyondEnd(const Points& cloud, const Points& normals, const Points& piece, double spacing);

/// The samples of a cloud, in the order of NormalizedCloud::points.
struct SampledSurface {
  const Points& points;              ///< 3 x N, N > 0
  const LocalGeometry& geometry;     ///< local geometry of the points
  const std::vector<char>& borders;  ///< what openBorders() returned
  double spacing;                    ///< median distance of the points
};

/// How well the end of a cloud explains that a sample has no counterpart under a plane.
///
/// Neighboring samples without counterpart form regions. A region is explained to the degree that its edge follows open
/// borders, of the samples or of their reflections, more than by chance: short edges may do so by chance, as may the
/// edge of a region that lies entirely near borders. It is also explained where its reflection lies beyond the end of
/// the cloud, see beyondEnd().
/// \param matched N values, 1 where the reflection of the sample lies on the surface.
/// \param closest N indices of the samples closest to the reflections; -1 = none is near.
/// \param reflected 3 x N, the reflections.
/// \return N values in [0, 1]: 0 for samples that have a counterpart or should have one, 1 where it is missing from the
/// cloud.
std::vector<float> missingCounterparts(const SampledSurface& surface, const std::vector<char>& matched,
                                       const std::vector<int>& closest, const Points& reflected);

/// Where a cloud ends although the object may continue: at open borders, and where its surface runs into its end. Not
/// in the paper.
///
/// For a true plane, unmatched points begin where the cloud or its reflection ends; for a false one, in the middle of
/// the surface.
struct SurfaceEnds {
  std::vector<char> borders;  ///< what openBorders() returned
  double trust;  ///< degree to which open borders excuse missing counterparts, in [0, 1]: 0 for a wire or an open sheet

  /// \param found the neighbors of the points.
  SurfaceEnds(const Points& points, const LocalGeometry& geometry, const ClosestPointSearch& search,
              const FoundNeighbors& found, int num_threads);
};

}  // namespace pcl_symmetry
