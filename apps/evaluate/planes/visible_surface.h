/// What a scanner sees of a mesh, and whether that rules a plane out.
#pragma once

#include <vector>

#include "evaluate/clouds/test_clouds.h"
#include "evaluate/mesh/mesh_reflection.h"
#include "evaluate/planes/plane_matching.h"

namespace pcl_symmetry::apps {

enum class ViewVerdict {
  Contradicted,  ///< a visible point rules the symmetry out
  Undecidable    ///< what contradicts it is hidden in this view
};

/// The part of a mesh that one scan shows, and the space that the scan shows to be empty. Decided on the mesh: neither
/// noise nor the points of the scan play a part.
class VisibleSurface {
public:
  /// \param scene,reflection of the mesh; both must outlive this object.
  /// \param tolerance greatest distance of a point on the surface from it, in diagonals.
  VisibleSurface(const TriangleScene& scene, const MeshReflection& reflection, const TestCloud& scan, double tolerance);

  /// A plane is contradicted where it maps more than 3 % of the visible surface to where the scan shows that nothing
  /// is: in the picture, before the first surface along the ray, and further than the tolerance from the mesh. An axis
  /// or a center is contradicted where one of 12 planes through it is.
  ViewVerdict verdictOf(const Answer& answer) const;

  /// \param plane in the frame of the scan.
  /// \return the share of the visible surface that it maps to where nothing is, in [0, 1]; 0 where nothing is visible.
  double contradictedShare(const ReflectionPlane& plane) const;

private:
  /// \param x in the frame of the scene.
  bool inPicture(const Eigen::Vector3d& x) const;
  /// Whether nothing lies between the scanner and the point.
  bool isInSight(const Eigen::Vector3d& x) const;

  const TriangleScene& scene_;
  MeshDistance distance_;
  Eigen::Isometry3d T_cloud_model_, T_sensor_cloud_;
  double half_width_, tolerance_;
  Eigen::Vector3d origin_;                ///< of the rays, in the frame of the scene
  std::vector<Eigen::Vector3d> visible_;  ///< points spread by area, in the frame of the scene
};

}  // namespace pcl_symmetry::apps
