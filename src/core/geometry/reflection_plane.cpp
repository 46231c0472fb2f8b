#include "pcl_symmetry/core/reflection_plane.h"

#include <cmath>

#include "core/base/check.h"
#include "core/geometry/directions.h"

namespace pcl_symmetry {

ReflectionPlane::ReflectionPlane(const Eigen::Vector3d& normal, double offset) {
  // Not stableNorm(), whose sum depends on the address of the vector.
  const double length = std::hypot(normal.x(), normal.y(), normal.z());
  check(std::isfinite(length) && length > 0.0, "normal", normal.transpose(), "finite and not zero");
  check(std::isfinite(offset), "offset", offset, "finite");
  normal_ = normal / length;
  offset_ = offset / length;
}

ReflectionPlane ReflectionPlane::between(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  const Eigen::Vector3d normal = y - x;
  return ReflectionPlane(normal, normal.dot(0.5 * (x + y)));
}

Eigen::Affine3d ReflectionPlane::reflection() const {
  Eigen::Affine3d reflection = Eigen::Affine3d::Identity();
  reflection.linear() -= 2.0 * normal_ * normal_.transpose();
  reflection.translation() = 2.0 * offset_ * normal_;
  return reflection;
}

ReflectionPlane ReflectionPlane::canonical() const {
  const auto& n = normal_;
  const bool flip = n.z() < 0.0 || (n.z() == 0.0 && (n.y() < 0.0 || (n.y() == 0.0 && n.x() < 0.0)));
  ReflectionPlane plane = *this;
  if (flip) {
    plane.normal_ = -normal_;
    plane.offset_ = -offset_;
  }
  return plane;
}

ReflectionPlane ReflectionPlane::transformed(const Eigen::Isometry3d& motion) const {
  const Eigen::Vector3d normal = motion.linear() * normal_;
  return ReflectionPlane(normal, offset_ + normal.dot(motion.translation()));
}

double ReflectionPlane::angleTo(const ReflectionPlane& other) const {
  return angleBetweenLines(normal_, other.normal_);
}

ReflectionPlane planeThrough(const Line3d& line, double angle) {
  const Eigen::Vector3d n = directionAcross<double>(line.direction(), angle);
  return ReflectionPlane(n, n.dot(line.origin()));
}

}  // namespace pcl_symmetry
