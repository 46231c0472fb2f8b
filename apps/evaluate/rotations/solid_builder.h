/// Triangles of bodies that are turned, swept or convex.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "evaluate/rotations/rotation_solids.h"

namespace pcl_symmetry::apps {

/// A curve in a plane: (x, y) of an outline, (radius, height) of a profile.
using Outline = std::vector<Eigen::Vector2d>;

/// Adds parts to a body.
class SolidBuilder {
public:
  explicit SolidBuilder(RotationSolid& solid) : solid_(solid) {}

  /// \param corners of a convex polygon, in order.
  SolidBuilder& face(const std::vector<Eigen::Vector3d>& corners);
  SolidBuilder& box(const Eigen::Vector3d& center, const Eigen::Vector3d& half,
                    const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity());
  /// A profile turned about z.
  SolidBuilder& turned(const Outline& profile);
  /// An outline about the origin, star-shaped, swept along z.
  /// \param bore radius of the hole along z; 0: none.
  SolidBuilder& swept(const Outline& outline, double low, double high, double bore = 0.0);
  /// The convex hull of a few points.
  SolidBuilder& hull(const std::vector<Eigen::Vector3d>& corners);
  /// An elliptic handle in the half plane x > 0, y = 0.
  /// \param foot place of its middle; \param reach,rise half axes; \param turn about z, radians.
  SolidBuilder& handle(const Eigen::Vector3d& foot, double reach, double rise, double thickness, double turn = 0.0);
  /// Moves each vertex.
  SolidBuilder& bent(const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& move);

private:
  RotationSolid& solid_;
};

}  // namespace pcl_symmetry::apps
