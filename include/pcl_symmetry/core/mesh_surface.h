#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Motions x -> R (x - center) + center that map a shape onto itself: R is a reflection or a rotation. They move
/// together, as those of a group or the planes of a frame.
struct MotionsAbout {
  std::vector<Eigen::Matrix3d> linear;               ///< R of each motion
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< input frame

  /// The reflection across a plane.
  /// \param near the center is the point of the plane that is closest to it.
  static MotionsAbout across(const ReflectionPlane& plane, const Eigen::Vector3d& near);
  /// The reflection across a plane through the center.
  void addReflection(const Eigen::Vector3d& unit_normal);
  /// Rotations that represent those by any angle.
  void addRotations(const Eigen::Vector3d& unit_axis);
};

/// How much of a mesh a motion maps onto the mesh.
struct MeshShares {
  double share = 1.0;      ///< of the area, mapped to within the tolerance
  double deviation = 0.0;  ///< 97 % of the area stay within it, input units
  double residual = 0.0;   ///< root mean square distance of what stays within the tolerance, input units
};

/// A mesh of triangles as the exact surface: its closest points are those of its triangles, not of samples.
class MeshSurface {
public:
  /// Builds the tree of the triangles.
  /// \param vertices 3 x V, input units; triangles with a vertex that is not finite are left out.
  /// \param triangles indices of vertices.
  /// \throws std::invalid_argument for an index that is no vertex, and a mesh without area.
  MeshSurface(const PointsRef& vertices, const std::vector<Eigen::Vector3i>& triangles);

  /// A rotation Q of the axes of motions, and their new center.
  struct Placement {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R becomes Q R Q^T
    Eigen::Vector3d center = Eigen::Vector3d::Zero();        ///< input frame
  };
  /// Where motions best map the surface onto itself: least squares of the distances of samples from the mesh, and of
  /// its open borders from the borders, with robust weights. Steps are those of Iterative Symmetric Points (Section
  /// 4.4).
  /// \return the start, if that is no worse.
  Placement fitted(const MotionsAbout& motions) const;
  /// The same for one plane.
  ReflectionPlane fitted(const ReflectionPlane& plane) const;

  /// Shares of the worst of the motions.
  /// \param tolerance input units, > 0.
  /// \param min_share measures the share alone, which is much faster; a share below it may be underestimated.
  MeshShares shares(const MotionsAbout& motions, double tolerance, std::optional<double> min_share = {}) const;
  /// The same for one plane.
  MeshShares shares(const ReflectionPlane& plane, double tolerance, std::optional<double> min_share = {}) const;

  const BoundingBall& ball() const;  ///< of the triangles, input frame
  int numSamples() const;            ///< that shares are measured on

private:
  struct Parts;
  std::shared_ptr<Parts> parts_;
};

}  // namespace pcl_symmetry
