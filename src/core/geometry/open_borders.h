#pragma once

#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Finds the points at the open borders of a sampled surface: the neighbors in the tangent plane leave a gap, and the
/// surface does not fold there.
/// \param samples 3 x N, finite.
/// \param search over the same samples.
/// \param normals 3 x N, unit.
/// \param known the closest points of each sample, as localGeometry() finds them: where these leave no gap, no more are
/// searched for; the answer is the same. Null = not known.
/// \return N values, 1 at a border.
std::vector<char> openBorders(const Points& samples, const ClosestPointSearch& search, const Points& normals,
                              int num_threads, const FoundNeighbors* known = nullptr);

/// The points within two steps of a border along neighbors: about three spacings.
/// \param borders what openBorders() returned.
/// \param geometry of the samples.
/// \return N values, 1 near a border.
std::vector<char> nearBorders(const std::vector<char>& borders, const LocalGeometry& geometry);

/// How often the position between two neighboring samples lies within about three spacings of an open border, by
/// chance.
/// \param borders what openBorders() returned.
/// \param geometry of the samples.
/// \return in [0, 1]; 0 for a closed surface, 1 for a wire.
double shareNearBorders(const std::vector<char>& borders, const LocalGeometry& geometry);

}  // namespace pcl_symmetry
