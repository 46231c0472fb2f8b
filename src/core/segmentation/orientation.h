#pragma once

#include <vector>

#include "pcl_symmetry/core/surface_graph.h"

namespace pcl_symmetry {

/// Outward normals: neighbors agree, and rays along the normals of a connected piece leave the shape more often than
/// rays against them.
/// \param graph with normals of any sign and with the index of its edges.
/// \param agreement one per edge: > 0 if the normals at both ends point to the same side, < 0 if they do not; a larger
/// magnitude is more certain.
/// \return 3 x N, each normal of the graph or its opposite.
Points outwardNormals(const SurfaceGraph& graph, const std::vector<float>& agreement);

}  // namespace pcl_symmetry
