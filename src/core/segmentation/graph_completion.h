#pragma once

#include <vector>

#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

/// The last steps of building a graph: index of the edges, outward normals, concavity of the edges.
/// \param graph with everything but first_edge, edge_of and the concavity of the edges; normals of any sign.
/// \param agreement one per edge, as in outwardNormals().
/// \return the complete graph.
SurfaceGraph completedGraph(SurfaceGraph graph, const std::vector<float>& agreement);

}  // namespace pcl_symmetry
