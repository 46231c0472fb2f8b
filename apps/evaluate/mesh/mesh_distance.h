/// The closest point of a mesh, exact where a cloud of samples would only be near.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "common/scanner/triangle_scene.h"

namespace pcl_symmetry::apps {

struct ClosestOnMesh {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  ///< of the triangle that holds it, unit, of either sign
  double distance;
};

/// Searches triangles in the frame of a TriangleScene: centred, unit diagonal. Safe to call from several threads.
class MeshDistance {
public:
  /// \param scene must outlive this object.
  explicit MeshDistance(const TriangleScene& scene) : scene_(scene) {}

  /// \return the closest point; none where the mesh is further away than \p max_distance.
  std::optional<ClosestOnMesh> closest(const Eigen::Vector3d& x,
                                       double max_distance = std::numeric_limits<double>::infinity()) const;

  /// \return whether any point of the mesh lies within the distance; stops at the first that does.
  bool within(const Eigen::Vector3d& x, double distance) const;

private:
  const TriangleScene& scene_;
};

/// \return the point of the triangle that is closest to \p x (Ericson, Real-Time Collision Detection, Section 5.1.5);
/// not finite where the corners coincide.
Eigen::Vector3d closestPoint(const Triangle& triangle, const Eigen::Vector3d& x);

}  // namespace pcl_symmetry::apps
