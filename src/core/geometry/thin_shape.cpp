#include "core/geometry/thin_shape.h"

#include <cmath>

#include "core/geometry/symmetric_share.h"

namespace pcl_symmetry {

Thinness thinnessOf(const PointsRef& points, const PrincipalAxes& axes, double plane_tolerance, double line_tolerance) {
  Eigen::Index num_near_plane = 0, num_near_line = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d x = axes.axes.transpose() * (points.col(i).cast<double>() - axes.center);
    num_near_plane += std::abs(x.z()) <= plane_tolerance ? 1 : 0;
    num_near_line += x.tail<2>().norm() <= line_tolerance ? 1 : 0;
  }
  const double least = kSymmetricShare * static_cast<double>(points.cols());
  if (static_cast<double>(num_near_line) >= least) return Thinness::Line;
  return static_cast<double>(num_near_plane) >= least ? Thinness::Sheet : Thinness::Solid;
}

}  // namespace pcl_symmetry
