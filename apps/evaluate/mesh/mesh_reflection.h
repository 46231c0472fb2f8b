/// How much of a mesh a plane reflects onto the mesh, and the plane near by that does it best.
#pragma once

#include <cstdint>

#include "evaluate/mesh/mesh_distance.h"
#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/geometry/reflection_plane.h"

namespace pcl_symmetry::apps {

/// Works in the frame of the TriangleScene, where one is the diagonal. Safe to call from several threads.
class MeshReflection {
public:
  /// \param scene must outlive this object.
  /// \param num_samples points spread over the mesh by area, >= 1.
  /// \throws std::invalid_argument where the mesh has no area.
  MeshReflection(const TriangleScene& scene, int num_samples, std::uint64_t seed);

  const Points& samples() const { return samples_; }

  /// Share of the area whose reflection lies within \p tolerance of the mesh, in [0, 1].
  /// \param stride uses one sample in this number.
  double share(const ReflectionPlane& plane, double tolerance, int stride = 1) const;

  /// Gauss-Newton steps on the distances d of the reflected samples from the mesh, weighted by 1 / (1 + d^2 / w^2)^2
  /// with w falling from \p width to \p final_width.
  ReflectionPlane refine(const ReflectionPlane& plane, double width, double final_width, int stride) const;

  /// The plane near by that maps most: moves by steps along each of its three freedoms while the share within the
  /// tolerance grows, and halves them where it does not.
  ReflectionPlane climb(const ReflectionPlane& plane, double tolerance, int stride) const;

private:
  MeshDistance distance_;
  Points samples_;  ///< neighbours in the order of the triangles, so that every k-th is spread evenly too
};

}  // namespace pcl_symmetry::apps
