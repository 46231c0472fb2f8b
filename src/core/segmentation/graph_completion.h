#pragma once

#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

/// The last steps of building a graph: index of the edges, outward normals, concavity of the edges.
/// \param graph with everything but first_edge, edge_of and the concavity of the edges; normals of any sign.
/// \param agreement one per edge: > 0 if the normals at both ends point to the same side, < 0 if they do not; a larger
/// magnitude is more certain.
SurfaceGraph completedGraph(SurfaceGraph graph, const std::vector<float>& agreement);

/// Refuses points whose distances have no squares in float: areas and neighbors would be infinite or zero.
/// \param points 3 x N; those that are not finite do not count.
/// \throws std::invalid_argument naming the extent and the rule.
void checkExtent(const PointsRef& points);

}  // namespace pcl_symmetry
