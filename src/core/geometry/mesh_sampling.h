#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// \return the triangles whose vertices are finite.
/// \throws std::invalid_argument for an index out of range.
std::vector<Eigen::Vector3i> finiteTriangles(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles);

/// Points spread evenly over triangles: one in each of num_points equal shares of the total area.
/// \param vertices 3 x V, input units.
/// \param triangles indices into the vertices; triangles with a vertex that is not finite are left out.
/// \param num_points >= 1.
/// \return 3 x num_points, in the order of the triangles.
/// \throws std::invalid_argument for an index out of range, or a total area of zero.
Points sampleTriangles(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles, int num_points,
                       std::uint64_t seed = 1);

/// The borders of a mesh: edges that have one triangle, by the positions of their ends, because files repeat vertices.
/// \param triangles indices of finite vertices.
/// \return indices of vertices.
std::vector<std::pair<int, int>> openEdges(const Points& vertices, const std::vector<Eigen::Vector3i>& triangles);

}  // namespace pcl_symmetry
