#pragma once

#include <vector>

#include "pcl_symmetry/core/surface/surface_graph.h"

namespace pcl_symmetry {

/// Turns the normals of a surface outward: alike along the surface, and each connected piece such that rays along its
/// normals leave the shape more often than rays against them.
/// \param agreement of each edge: > 0 where the normals at both ends point to the same side, < 0 where they do not; the
/// larger its magnitude, the surer.
void orientNormals(SurfaceGraph& graph, const std::vector<float>& agreement);

}  // namespace pcl_symmetry
