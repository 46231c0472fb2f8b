#include "core/registration/visible_points.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/registration/registration_rules.h"

namespace pcl_symmetry {

namespace {

/// Whether a depth image shows a surface in front of a point, or slightly beside it.
/// \param margin least distance of that surface from the point.
/// \param beside how far from the ray of the point the surface may be; 0 = only on its ray.
bool isHidden(const Visibility& view, const Eigen::Vector3d& x, const Eigen::Vector3d& ray, double margin,
              double beside) {
  const Eigen::Vector3d u = beside * ray.unitOrthogonal(), v = ray.cross(u);
  const auto isBehind = [&](const Eigen::Vector3d& at) { return view.depthBehind(at) > margin; };
  return isBehind(x) || (beside > 0.0 && (isBehind(x + u) || isBehind(x - u) || isBehind(x + v) || isBehind(x - v)));
}

}  // namespace

std::vector<VisiblePoint> visiblePoints(const PosedSurface& surface, const PosedSurface& scan,
                                        const Eigen::Isometry3d& T_scan_surface, int num_points, bool is_strict) {
  const auto size = std::min<Eigen::Index>(num_points, surface.points.cols());
  const Eigen::Isometry3f pose = T_scan_surface.cast<float>();
  Points positions(3, size);
  for (Eigen::Index i = 0; i < size; ++i) positions.col(i) = pose * surface.points.col(surface.order[i]);
  const Eigen::Vector3d viewpoint = scan.seen->viewpoint();
  const std::optional<Visibility> view = Visibility::fromPoints(positions, viewpoint);
  std::vector<VisiblePoint> visible;
  if (!view) return visible;
  const double margin = kRegistration.hidden_depth * boundingBall(surface.points).radius;
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Vector3d x = positions.col(i).cast<double>(), ray = (x - viewpoint).normalized();
    const Eigen::Vector3d n = (pose.linear() * surface.normals.col(surface.order[i])).cast<double>();
    const double cosine = std::abs(n.dot(ray));
    if (cosine < kRegistration.min_cosine || isHidden(*view, x, ray, margin, is_strict ? margin : 0.0)) continue;
    visible.push_back({i, x, n, cosine, -scan.seen->depthBehind(x) * cosine});
  }
  return visible;
}

}  // namespace pcl_symmetry
