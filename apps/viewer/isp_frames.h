/// Iterative Symmetric Points, step by step, as the paper's Figure 7 shows it.
#pragma once

#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry::apps {

/// One iteration before its step: some samples, their reflections, and the closest points of the surface.
struct IspFrame {
  ReflectionPlane plane;
  Points samples, reflections, closest;  ///< 3 x M each; samples whose reflection is far from the surface are left out
  double residual = 0.0;                 ///< weighted root mean square distance of all pairs, units of the points
};

/// From a plane beside the given one (turned by 12 degrees, shifted by 5 % of the radius) back to rest.
/// \param points 3 x N, finite, about the origin, of radius 1.
/// \return one frame or more, the last at rest.
std::vector<IspFrame> ispFrames(const Points& points, const ReflectionPlane& plane);

}  // namespace pcl_symmetry::apps
