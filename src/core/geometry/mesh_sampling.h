#pragma once

#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// Points spread over triangles by area: one in each of num_points equal shares of the total area, in the order of the
/// triangles.
/// \param vertices 3 x V. \param triangles indices into the vertices; those with a non-finite vertex are left out.
/// \param num_points >= 1. \return 3 x num_points.
/// \throws std::invalid_argument where an index is out of range or the total area is zero.
Points sampleTriangles(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles, int num_points,
                       std::uint64_t seed = 1);

}  // namespace pcl_symmetry
