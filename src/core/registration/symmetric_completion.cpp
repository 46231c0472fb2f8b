#include "pcl_symmetry/core/symmetric_completion.h"

#include <cmath>

#include "core/base/check.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"

namespace pcl_symmetry {

void CompletionOptions::validate() const {
  check(overlap > 0.0, "overlap", overlap, "> 0");
  check(margin >= 0.0, "margin", margin, ">= 0");
  checkNumThreads(num_threads);
}

ReflectionPlane planeAcrossView(const Line3d& axis, const Eigen::Vector3d& viewpoint) {
  constexpr double kLeastSine = 1e-6;  // a viewpoint closer to the axis gives no direction
  const Eigen::Vector3d view = viewpoint - axis.origin();
  const Eigen::Vector3d across = view - axis.direction().dot(view) * axis.direction();
  const Eigen::Vector3d normal =
      across.norm() > kLeastSine * view.norm() ? across.normalized() : axis.direction().unitOrthogonal();
  return ReflectionPlane(normal, normal.dot(axis.origin()));
}

std::optional<ReflectionPlane> planeAcrossView(const Detection& found, const Eigen::Vector3d& viewpoint) {
  if (!found.centers.empty()) {
    const Eigen::Vector3d center = found.centers.front().point, view = viewpoint - center;
    return planeAcrossView({center, view.isZero() ? Eigen::Vector3d::UnitZ() : view.unitOrthogonal()}, viewpoint);
  }
  if (found.axes.empty()) return std::nullopt;
  return planeAcrossView({found.axes.front().point, found.axes.front().direction}, viewpoint);
}

std::vector<int> completingPoints(const PointsRef& points, const ReflectionPlane& plane,
                                  const CompletionOptions& options, const Visibility* visibility) {
  options.validate();
  std::vector<int> completing;
  if (points.cols() == 0) return completing;
  const auto search = makeFlannSearch(points);
  const LocalGeometry geometry = localGeometry(points, *search, options.num_threads);
  const Points reflected = reflectedPoints(points, plane);
  const ClosestPoints closest = closestPoints(*search, reflected, options.num_threads);
  for (int i = 0; i < static_cast<int>(points.cols()); ++i) {
    const double spacing = geometry.spacing[closest.index[i]];
    if (std::sqrt(closest.sq_distances[i]) > options.overlap * spacing &&
        !(visibility && visibility->depthBehind(reflected.col(i).cast<double>()) < -options.margin * spacing))
      completing.push_back(i);
  }
  return completing;
}

}  // namespace pcl_symmetry
