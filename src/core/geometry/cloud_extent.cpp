#include "core/geometry/cloud_extent.h"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/base/symmetric_solvers.h"
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
  const SymmetricEigen<Eigen::Matrix3d> solver(covariance);
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
  const double min_count = kSymmetricShare * static_cast<double>(points.cols());
  if (static_cast<double>(num_near_line) >= min_count) return Thinness::Line;
  return static_cast<double>(num_near_plane) >= min_count ? Thinness::Sheet : Thinness::Solid;
}

namespace {

/// Index and squared distance of the point farthest from a position.
std::pair<Eigen::Index, float> farthestOf(const Eigen::Vector3f& position, const PointsRef& points) {
  Eigen::Index index = 0;
  const auto squares = (points.colwise() - position).array().square();
  const float sq_distance = (squares.row(0) + squares.row(1) + squares.row(2)).maxCoeff(&index);
  return {index, sq_distance};
}

}  // namespace

double approximateDiameter(const PointsRef& points) {
  if (points.cols() < 2) return 0.0;
  Eigen::Index at = farthestOf(centerOfMass(points).cast<float>(), points).first;
  double distance = -1.0;
  for (double longer = 0.0; longer > distance;) {
    distance = longer;
    const auto [farthest, sq_distance] = farthestOf(points.col(at), points);
    at = farthest;
    longer = std::sqrt(static_cast<double>(sq_distance));
  }
  return distance;
}

}  // namespace pcl_symmetry
