#include "core/geometry/principal_axes.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

PrincipalAxes principalAxes(const PointsRef& points) {
  if (points.cols() == 0) throw std::invalid_argument("points: 0 given, must be >= 1");
  PrincipalAxes axes;
  axes.center = centerOfMass(points);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d d = points.col(i).cast<double>() - axes.center;
    covariance += d * d.transpose();
  }
  covariance /= static_cast<double>(points.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  axes.axes = solver.eigenvectors().rowwise().reverse();
  axes.variances = solver.eigenvalues().reverse().cwiseMax(0.0);
  if (axes.axes.determinant() < 0.0) axes.axes.col(2) *= -1.0;
  return axes;
}

std::vector<ReflectionPlane> principalPlanes(const PrincipalAxes& axes) {
  std::vector<ReflectionPlane> planes;
  for (int i = 0; i < 3; ++i) planes.emplace_back(axes.axes.col(i), axes.axes.col(i).dot(axes.center));
  return planes;
}

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
