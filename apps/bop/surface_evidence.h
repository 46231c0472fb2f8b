/// How well a rigid motion maps a surface onto itself.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry::apps {

struct MotionEvidence {
  double share = 1.0;      ///< of the surface that is mapped to within the tolerance of the surface
  double mean = 0.0;       ///< mean distance of mapped points from the surface, input units
  double deviation = 0.0;  ///< 97 % of the mapped points stay within it, input units
};

/// Samples of a surface, with the plane that each stands for.
class SurfaceEvidence {
public:
  /// \param points 3 x N, finite, at least 20 distinct ones.
  /// \param tolerance input units, > 0.
  SurfaceEvidence(Points points, double tolerance);

  MotionEvidence of(const Eigen::Isometry3d& motion) const;
  /// \return distance of each moved point from the surface, input units.
  std::vector<double> distances(const Eigen::Isometry3d& motion) const;

  const Points& points() const { return points_; }
  double tolerance() const { return tolerance_; }

private:
  Points points_;
  double tolerance_;
  ClosestPointSearch::Ptr search_;
  LocalGeometry geometry_;
};

}  // namespace pcl_symmetry::apps
