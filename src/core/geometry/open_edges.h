#pragma once

#include <utility>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The borders of a mesh: edges that have one triangle, by the positions of their ends, because files repeat vertices.
/// \param triangles indices of finite vertices.
/// \return indices of vertices.
std::vector<std::pair<int, int>> openEdges(const Points& vertices, const std::vector<Eigen::Vector3i>& triangles);

}  // namespace pcl_symmetry
