/// Whether the segments of a symmetric surface are each other's mirror images.
#pragma once

#include <vector>

#include "pcl_symmetry/core/geometry/reflection_plane.h"
#include "pcl_symmetry/core/surface/surface_graph.h"

namespace pcl_symmetry::apps {

/// Share of the area whose reflection in a plane lies in the partner of its segment, in [0, 1]. The partner of a
/// segment is the one that receives most of its reflection. The plane comes from elsewhere: nothing that made the
/// labels is asked.
/// \param labels one per element, from 0.
double mirrorAgreement(const SurfaceGraph& graph, const std::vector<int>& labels, const ReflectionPlane& plane);

}  // namespace pcl_symmetry::apps
