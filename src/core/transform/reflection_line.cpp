#include "pcl_symmetry/core/line_transform.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"

namespace pcl_symmetry {

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
