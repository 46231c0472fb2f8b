/// What motions map off a mesh, by exact distances.
#pragma once

#include <pcl/PolygonMesh.h>

#include <Eigen/Geometry>
#include <vector>

#include "core/rotation/rotation_fit.h"
#include "evaluate/mesh/mesh_distance.h"
#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry::apps {

/// True shares of motions of the input frame. Safe to call from several threads.
class TrueShares {
public:
  /// \param tolerance input units, > 0.
  /// \throws std::invalid_argument where the mesh has no area.
  TrueShares(const pcl::PolygonMesh& mesh, double tolerance);

  OffShares of(const Eigen::Isometry3d& motion) const;
  /// The greatest of each share.
  OffShares worstOf(const std::vector<Eigen::Isometry3d>& motions) const;

private:
  TriangleScene scene_;
  MeshDistance distance_;
  Points samples_;
  double tolerance_;  ///< diagonals
};

/// The greatest distance between two points of a mesh, input units.
/// \throws std::invalid_argument for a mesh without triangles.
double diameterOf(const pcl::PolygonMesh& mesh);

/// The turn about a line by an angle in radians.
/// \param direction unit.
Eigen::Isometry3d turnAbout(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double angle);

/// Turns that stand for those by any angle.
std::vector<Eigen::Isometry3d> turnsByAnyAngle(const Eigen::Vector3d& point, const Eigen::Vector3d& direction);

}  // namespace pcl_symmetry::apps
