#include "evaluate/shared/plane_difference.h"

#include <algorithm>
#include <cmath>

namespace pcl_symmetry::apps {

Difference difference(const ReflectionPlane& a, const ReflectionPlane& b, const Eigen::Vector3d& center) {
  const double sign = a.normal().dot(b.normal()) < 0.0 ? -1.0 : 1.0;
  return {a.angleTo(b), std::abs(a.signedDistance(center) - sign * b.signedDistance(center))};
}

Difference difference(const ReflectionPlane& plane, const Line3d& line, const Eigen::Vector3d& center) {
  return {std::asin(std::min(1.0, std::abs(plane.normal().dot(line.direction())))),
          std::abs(plane.signedDistance(line.projection(center)))};
}

Difference difference(const Line3d& a, const Line3d& b, const Eigen::Vector3d& center) {
  return {std::atan2(a.direction().cross(b.direction()).norm(), std::abs(a.direction().dot(b.direction()))),
          a.distance(b.projection(center))};
}

}  // namespace pcl_symmetry::apps
