#include "evaluate/registration/motion_error.h"
#include "core/base/constants.h"

#include <cmath>
#include <limits>
#include <vector>

namespace pcl_symmetry::apps {

namespace {

/// Cosine of the angle up to which a plane lies across an axis. chosen: the angle at which planes count as found.
const double kAcross = std::cos(3.0 * kPi / 180.0);

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Keeps the error that comes closest, in units of what is allowed for both, which the diagonal relates.
class Closest {
public:
  explicit Closest(double diagonal) : diagonal_(diagonal) {}

  void offer(double angle, double distance) {
    constexpr double kAngle = 5.0 * kPi / 180.0, kDistance = 0.02;  // chosen: the default limits of the evaluation
    const double size = std::max(angle / kAngle, distance / (kDistance * diagonal_));
    if (!(size < size_)) return;
    size_ = size;
    error_ = {angle, distance};
  }

  MotionError error() const { return error_; }

private:
  double diagonal_;
  double size_ = std::numeric_limits<double>::infinity();
  MotionError error_;
};

}  // namespace

MotionError motionError(const Eigen::Isometry3d& T_model_scan, const Eigen::Isometry3d& T_model_scan_true,
                        const ReferenceSymmetries& symmetries) {
  const Eigen::Isometry3d error = T_model_scan * T_model_scan_true.inverse();
  const Eigen::Vector3d& center = symmetries.center;
  Closest closest(symmetries.diagonal);
  const auto offer = [&](const Eigen::Isometry3d& symmetry) {
    closest.offer(Eigen::AngleAxisd(error.linear() * symmetry.linear().transpose()).angle(),
                  (error * center - symmetry * center).norm());
  };
  offer(Eigen::Isometry3d::Identity());
  for (const ReferencePlane& a : symmetries.planes) {
    for (const ReferencePlane& b : symmetries.planes) {
      const Eigen::Affine3d product = a.plane.reflection() * b.plane.reflection();
      if (&a != &b) offer(Eigen::Isometry3d(product.matrix()));
    }
  }
  for (const ReferenceAxis& axis : symmetries.axes) {
    const Eigen::Vector3d point = axis.point + axis.direction.dot(center - axis.point) * axis.direction;
    const Eigen::Vector3d moved = error * point, direction = error.linear() * axis.direction;
    closest.offer(angleBetween(direction, axis.direction), (moved - point).norm());
    for (const ReferencePlane& plane : symmetries.planes)
      if (std::abs(plane.plane.normal().dot(axis.direction)) > kAcross)
        closest.offer(angleBetween(direction, -axis.direction), (moved - plane.plane.reflect(point)).norm());
  }
  for (const ReferenceCenter& sphere : symmetries.centers)
    closest.offer(0.0, (error * sphere.point - sphere.point).norm());
  return closest.error();
}

}  // namespace pcl_symmetry::apps
