/// Tries all planes through a mesh, two degrees and one per cent of the diagonal apart, and keeps the local maxima.
#pragma once

#include <vector>

#include "common/scanner/triangle_scene.h"
#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/geometry/reflection_plane.h"

namespace pcl_symmetry::apps {

struct ScannedPlane {
  ReflectionPlane plane;
  double
      closeness;  ///< mean over the samples of (1 - d^2 / reach^2)^2, d the distance of the reflected sample; in [0, 1]
};

/// By brute force on the mesh: reflects samples of the surface and looks up how far from the triangles they land. It
/// has nothing in common with the detector but the type of a plane and the starting of threads.
/// \param samples of the surface, spread by area, in the frame of the scene.
/// \return planes whose closeness no neighbour exceeds, best first, in the frame of the scene.
std::vector<ScannedPlane> scanPlanes(const TriangleScene& scene, const Points& samples, int num_threads);

}  // namespace pcl_symmetry::apps
