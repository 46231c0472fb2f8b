#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Points of a surface and its normals there.
struct SurfacePoints {
  Points points;   ///< 3 x N
  Points normals;  ///< 3 x N, unit, of any sign
};

/// A few points of a surface, evenly spread: none is much closer to another than their number requires.
/// \param points 3 x N, finite, N >= 1.
/// \return about \p count points, at most that many, in random order: the first k are spread over the surface, too. All
/// points if there are no more.
SurfacePoints evenSurfacePoints(const Points& points, int count, std::uint64_t seed);

/// The same for several counts.
std::vector<SurfacePoints> evenSurfacePoints(const Points& points, const std::vector<int>& counts, std::uint64_t seed);

}  // namespace pcl_symmetry
