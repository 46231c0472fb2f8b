#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry {

/// The directions that the surface of a shape faces: one normal for each cell of a coarse grid that the surface passes.
class SurfaceDirections {
public:
  /// \param points 3 x N, finite, input units.
  /// \param edt distance transform of the points: its cube is cut into half as many cells along each side.
  SurfaceDirections(const PointsRef& points, const GaussianEdt& edt);

  /// How well the surface agrees with an axis: the mean over the cells of 1 where the normal is parallel or
  /// perpendicular to the axis, falling to 0 within 6 degrees. A box agrees with its own axes everywhere.
  /// \param axis unit.
  /// \return in [0, 1].
  double agreement(const Eigen::Vector3f& axis) const;

  /// Directions that many normals share: the normals of the faces of a shape.
  /// \return unit directions, those shared by most of the surface first.
  std::vector<Eigen::Vector3f> peaks(int max_peaks) const;

private:
  Eigen::Matrix3Xf normals_;
  Eigen::ArrayX3f by_axis_;  // the same, their coordinates side by side
  Eigen::VectorXf weights_;  // sum to 1
};

}  // namespace pcl_symmetry
