#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Motions x -> R (x - center) + center that map a shape onto itself: R is a reflection or a rotation. All motions are
/// moved together, such as those of a group or the planes of a frame.
struct MotionsAbout {
  std::vector<Eigen::Matrix3d> linear;               ///< R of each motion
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< common fixed point of the motions, input frame

  /// The reflection in a plane.
  /// \param near the center becomes the point of the plane closest to this point.
  static MotionsAbout across(const ReflectionPlane& plane, const Eigen::Vector3d& near);
  /// Adds the reflection in a plane through the center.
  void addReflection(const Eigen::Vector3d& unit_normal);
  /// Adds a few rotations that represent the rotations by any angle.
  void addRotations(const Eigen::Vector3d& unit_axis);
};

/// How well motions map a mesh onto itself.
struct MeshShares {
  double share = 1.0;      ///< share of the area that is mapped to within the tolerance, in [0, 1]
  double deviation = 0.0;  ///< distance within which 97 % of the area stays, input units
  double residual = 0.0;   ///< root mean square distance of the area within the tolerance, input units
};

/// A triangle mesh as the exact surface: closest points are searched on its triangles, not among samples.
class MeshSurface {
public:
  /// Builds the tree of the triangles.
  /// \param vertices 3 x V, input units; triangles with a vertex that is not finite are left out.
  /// \param triangles indices of vertices.
  /// \throws std::invalid_argument for an index out of range, and for a mesh without area.
  MeshSurface(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles);

  /// A rotation Q of the axes of motions, and a new center.
  struct Placement {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< Q: each R becomes Q R Q^T
    Eigen::Vector3d center = Eigen::Vector3d::Zero();        ///< the new center, input frame
  };
  /// Finds the placement in which the motions best map the surface onto itself: least squares of the distances from
  /// samples to the mesh, and from its open borders to the borders, with robust weights, by steps as in
  /// Iterative Symmetric Points (Section 4.4).
  /// \return that placement, or the given one if it fits no worse.
  Placement fitted(const MotionsAbout& motions) const;
  /// The same for one plane.
  ReflectionPlane fitted(const ReflectionPlane& plane) const;

  /// The least share, and the greatest deviation and residual, of the motions.
  /// \param tolerance input units, > 0.
  /// \param min_share if set, only the share is measured, which is much faster; a share below it may be underestimated.
  MeshShares shares(const MotionsAbout& motions, double tolerance, std::optional<double> min_share = {}) const;
  /// The same for one plane.
  MeshShares shares(const ReflectionPlane& plane, double tolerance, std::optional<double> min_share = {}) const;

  const BoundingBall& ball() const;  ///< bounding ball of the triangles, input frame
  int numSamples() const;            ///< number of samples by which shares are measured

private:
  struct Parts;
  std::shared_ptr<Parts> parts_;
};

}  // namespace pcl_symmetry
