#pragma once

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// Refuses points whose distances have no squares in float: areas and neighbors would be infinite or zero.
/// \param points 3 x N; those that are not finite do not count.
/// \throws std::invalid_argument naming the extent and the rule.
void checkExtent(const PointsRef& points);

}  // namespace pcl_symmetry
