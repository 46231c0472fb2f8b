#pragma once

#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The points that lie far from all others, alone or in tiny groups: flying pixels of cameras, outliers of
/// photogrammetry, positions that a driver set to zero. They would stretch the diameter that a tolerance is a share of.
///
/// Nine tenths of the points lie within some distance of the middle of the cloud; twice that distance is its size.
/// Points that are farther out than that distance by a gap, and from which no chain of points with shorter gaps leads
/// back, are stray. The gap is two fifths of the size or ten spacings of a surface, so that tails, antennas and sparse
/// samples belong to the cloud. Where more than one point in twenty would be stray, none is.
/// \param points 3 x N; none is stray where one is not finite.
/// \return their indices, rising; mostly none, which a few passes over the points tell.
std::vector<int> strayPoints(const PointsRef& points);

/// \param stray indices, rising.
/// \return the indices of the other points, rising.
std::vector<int> allBut(const std::vector<int>& stray, Eigen::Index size);

/// \return 3 x M, the points without those that are stray.
Points withoutStrayPoints(const PointsRef& points);

}  // namespace pcl_symmetry
