#include "pcl_symmetry/core/line_transform.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"

namespace pcl_symmetry {

LineGrid::LineGrid(int num_theta, int num_radius, const Eigen::Vector2d& center, double radius)
    : num_theta_(num_theta), num_radius_(num_radius), center_(center), radius_(radius) {
  check(num_theta >= 1 && num_theta <= 4096, "num_theta", num_theta, "in [1, 4096]");
  check(num_radius >= 1 && num_radius <= 4096, "num_radius", num_radius, "in [1, 4096]");
  check(center.allFinite(), "center", center.transpose(), "finite");
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
}

double LineGrid::thetaStep() const {
  return kPi / num_theta_;
}
double LineGrid::radiusStep() const {
  return 2.0 * radius_ / num_radius_;
}

LineGrid::Bin LineGrid::bin(std::size_t index) const {
  return {static_cast<int>(index / num_radius_), static_cast<int>(index % num_radius_)};
}

ReflectionLine LineGrid::line(const Bin& bin) const {
  const double angle = theta(bin.theta);
  return {angle, offset(bin.radius) + center_.dot(Eigen::Vector2d(std::cos(angle), std::sin(angle)))};
}

std::optional<LineGrid::Bin> LineGrid::find(const ReflectionLine& line) const {
  const ReflectionLine c = line.canonical();
  const double r = -c.signedDistance(center_);
  if (std::abs(r) > radius_) return std::nullopt;
  return Bin{std::clamp(static_cast<int>(c.theta() / thetaStep()), 0, num_theta_ - 1),
             std::clamp(static_cast<int>((r + radius_) / radiusStep()), 0, num_radius_ - 1)};
}

std::optional<LineGrid::Bin> LineGrid::step(const Bin& bin, int dt, int dk) const {
  Bin to{bin.theta + dt, bin.radius + dk};
  if (to.radius < 0 || to.radius >= num_radius_) return std::nullopt;
  if (to.theta < 0 || to.theta >= num_theta_) {
    to.theta = (to.theta + num_theta_) % num_theta_;
    to.radius = num_radius_ - 1 - to.radius;
  }
  return to;
}

std::size_t LineMap::strongest() const {
  return values.empty() ? 0 : std::max_element(values.begin(), values.end()) - values.begin();
}

ReflectionLine::ReflectionLine(double theta, double offset)
    : theta_(theta), offset_(offset), normal_(std::cos(theta), std::sin(theta)) {
  check(std::isfinite(theta), "theta", theta, "finite");
  check(std::isfinite(offset), "offset", offset, "finite");
}

ReflectionLine ReflectionLine::canonical() const {
  const double half_turns = std::floor(theta_ / kPi);
  const double theta = theta_ - half_turns * kPi;
  const double offset = std::fmod(half_turns, 2.0) == 0.0 ? offset_ : -offset_;
  // Just below zero, theta + pi rounds to pi.
  return theta < kPi ? ReflectionLine(theta, offset) : ReflectionLine(0.0, -offset);
}

double ReflectionLine::angleTo(const ReflectionLine& other) const {
  const double cross = normal_.x() * other.normal_.y() - normal_.y() * other.normal_.x();
  return std::atan2(std::abs(cross), std::abs(normal_.dot(other.normal_)));
}

}  // namespace pcl_symmetry
