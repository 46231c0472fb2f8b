#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"
#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry {

/// Which way the surface of a shape faces: one normal for each cell of a coarse grid that the surface passes, so that
/// neither the density of the points nor noise below the size of a cell matters.
class SurfaceDirections {
public:
  /// \param edt of the points: its cube is cut into half as many cells along each side.
  SurfaceDirections(const PointsRef& points, const GaussianEdt& edt);

  /// How far the surface agrees with an axis: mean over the cells of 1 where the normal is parallel or perpendicular to
  /// it, falling to 0 within a few degrees. A box agrees with its own axes everywhere.
  double agreement(const Eigen::Vector3f& axis) const;

  /// Directions that many normals share, those of most first: the faces of a shape.
  std::vector<Eigen::Vector3f> peaks(int max_peaks) const;

private:
  Eigen::Matrix3Xf normals_;
  Eigen::VectorXf weights_;  // sum to 1
};

}  // namespace pcl_symmetry
