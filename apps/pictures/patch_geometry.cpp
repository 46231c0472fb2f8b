#include "pictures/patch_geometry.h"

#include <pcl/common/point_tests.h>

#include <algorithm>
#include <limits>

#include "core/base/symmetric_solvers.h"
#include "core/geometry/surface_normals.h"
#include "io/shape_input.h"
#include "pcl_symmetry/core/closest_point_search.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kShadingNeighbors = 12;  // neighbors that give the normal of a point
constexpr std::size_t kMinShadedPoints = 16;

/// \return the corners of the square of the given size around the given center, upright as far as the plane allows.
std::array<Eigen::Vector3d, 4> squareCorners(const PlanePatch& plane, const Eigen::Vector3d& up) {
  const double length = plane.normal.norm();
  const Eigen::Vector3d normal = plane.normal / length;
  const Eigen::Vector3d center = plane.center - (normal.dot(plane.center) - plane.offset / length) * normal;
  Eigen::Vector3d v = up.normalized() - normal.dot(up.normalized()) * normal;
  if (v.norm() < 0.1) v = normal.unitOrthogonal();
  v.normalize();
  const Eigen::Vector3d u = normal.cross(v);
  const double h = plane.half_size;
  return {center - h * u - h * v, center + h * u - h * v, center + h * u + h * v, center - h * u + h * v};
}

std::array<Eigen::Vector3d, 4> fittedCorners(const PlanePatch& plane, const Cloud& points) {
  const Eigen::Vector3d normal = plane.normal.normalized(), s = normal.unitOrthogonal(), t = normal.cross(s);
  std::vector<Eigen::Vector2d> projections;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second_moment = Eigen::Matrix2d::Zero();
  for (const pcl::PointXYZ& point : points) {
    const Eigen::Vector3d position = point.getVector3fMap().cast<double>();
    if (!position.allFinite()) continue;
    projections.emplace_back(s.dot(position), t.dot(position));
    mean += projections.back();
  }
  mean /= static_cast<double>(projections.size());
  for (const Eigen::Vector2d& q : projections) second_moment += (q - mean) * (q - mean).transpose();
  const Eigen::Matrix2d axes = SymmetricEigen<Eigen::Matrix2d>(second_moment).eigenvectors();
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& q : projections) box.extend(axes.transpose() * q);
  const double margin = 0.06 * box.diagonal().norm();
  box.extend(box.min() - Eigen::Vector2d::Constant(margin)).extend(box.max() + Eigen::Vector2d::Constant(margin));
  const auto corner = [&](double u, double v) -> Eigen::Vector3d {
    const Eigen::Vector2d q = axes * Eigen::Vector2d(u, v);
    return plane.offset / plane.normal.norm() * normal + q.x() * s + q.y() * t;
  };
  return {corner(box.min().x(), box.min().y()), corner(box.max().x(), box.min().y()),
          corner(box.max().x(), box.max().y()), corner(box.min().x(), box.max().y())};
}

}  // namespace

Normalization normalizationOf(const PictureScene& scene) {
  const Points points = finitePoints(*scene.points);
  if (points.cols() == 0) throw InputError("nothing to draw, no point is finite");
  const Eigen::AlignedBox3d box(points.rowwise().minCoeff().cast<double>(), points.rowwise().maxCoeff().cast<double>());
  const double diagonal = box.diagonal().norm();
  return {box.center(), diagonal > 0 ? 1.0 / diagonal : 1.0};
}

Points pointNormals(const Cloud& points, const Normalization& normalize) {
  Points result = Points::Constant(3, points.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<std::size_t> index;
  Points finite = finitePoints(points, &index);
  if (index.size() < kMinShadedPoints || index.size() > kMaxShadedPoints) return result;
  for (auto x : finite.colwise()) x = normalize(x.cast<double>()).cast<float>();
  const Points normals = localGeometry(finite, *makeFlannSearch(finite), 0, nullptr, kShadingNeighbors).normals;
  for (std::size_t i = 0; i < index.size(); ++i) result.col(index[i]) = normals.col(i);
  return result;
}

Eigen::Vector3d pointColor(const PicturePanel& panel, std::size_t point) {
  if (!panel.support.empty()) return cividis(panel.support[point]);
  if (!panel.segments.empty()) return segmentColor(panel.segments[point]);
  return kPlainPointColor;
}

PointShade shadeOf(bool colored) {
  return colored ? PointShade{0.65, 0.35} : PointShade{0.45, 0.75};
}

std::array<Eigen::Vector3d, 4> patchCorners(const PlanePatch& plane, const PictureScene& scene) {
  return plane.half_size > 0 ? squareCorners(plane, scene.up) : fittedCorners(plane, *scene.points);
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> axisEnds(const AxisLine& axis, const PictureScene& scene) {
  const Eigen::Vector3d direction = axis.direction.normalized();
  double low = -axis.half_length, high = axis.half_length;
  if (!(axis.half_length > 0.0)) {
    low = std::numeric_limits<double>::infinity();
    high = -low;
    for (const pcl::PointXYZ& point : *scene.points) {
      if (!pcl::isXYZFinite(point)) continue;
      const double along = direction.dot(point.getVector3fMap().cast<double>() - axis.point);
      low = std::min(low, along);
      high = std::max(high, along);
    }
    const double margin = 0.1 * (high - low);
    low -= margin;
    high += margin;
  }
  return {axis.point + low * direction, axis.point + high * direction};
}

}  // namespace pcl_symmetry::apps
