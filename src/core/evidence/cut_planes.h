#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// A plane at which a cloud was cut off: nothing is known where normal . x > offset.
struct CutPlane {
  Eigen::Vector3f normal;  ///< unit, away from the cloud
  float offset;            ///< units of the points
};

/// Finds the planes at which a cloud was cut off: all points lie on one side, and where they come near to it they are
/// at open borders.
///
/// Not in the paper. Where a piece was cut off by a plane, whole parts of the object may lack their counterpart: they
/// have no edge to matched points that would tell so, but their reflections lie beyond the plane of the cut. The rim of
/// an open vessel is such a plane too.
/// \param borders whether each point is at an open border of the surface, as from openBorders().
/// \param spacing median distance of the points.
/// \param seed of the draws.
/// \return at most four, those with most border points first.
std::vector<CutPlane> findCutPlanes(const Points& points, const std::vector<char>& borders, double spacing,
                                    std::uint64_t seed);

}  // namespace pcl_symmetry
