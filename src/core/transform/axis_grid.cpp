#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "pcl_symmetry/core/axial_transform.h"

namespace pcl_symmetry {

AxisGrid::AxisGrid(int num_theta, int num_phi, int num_offset, const Eigen::Vector3d& center, double radius)
    : num_theta_(num_theta), num_phi_(num_phi), num_offset_(num_offset), center_(center), radius_(radius) {
  constexpr int most = 1024;                     // 0.1 degrees
  constexpr std::size_t most_bins = 1ull << 28;  // 1 GiB for each fold
  check(num_theta >= 1 && num_theta <= most, "num_theta", num_theta, "in [1, 1024]");
  check(num_phi >= 2 && num_phi <= most && num_phi % 2 == 0, "num_phi", num_phi, "even and in [2, 1024]");
  check(num_offset >= 1 && num_offset <= most, "num_offset", num_offset, "in [1, 1024]");
  check(size() <= most_bins, "number of bins", size(), "at most 268435456");
  check(center.allFinite(), "center", center.transpose(), "finite");
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
}

std::size_t AxisGrid::index(const Bin& bin) const {
  const std::size_t direction = static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi;
  return (direction * num_offset_ + bin.v) * num_offset_ + bin.u;
}

AxisGrid::Bin AxisGrid::bin(std::size_t index) const {
  const std::size_t row = index / num_offset_, direction = row / num_offset_;
  return {static_cast<int>(direction / num_phi_), static_cast<int>(direction % num_phi_),
          static_cast<int>(index % num_offset_), static_cast<int>(row % num_offset_)};
}

Eigen::Matrix3d AxisGrid::frame(std::size_t direction) const {
  const double theta = (direction / num_phi_ + 0.5) * 0.5 * kPi / num_theta_;
  const double phi = (direction % num_phi_ + 0.5) * 2.0 * kPi / num_phi_;
  Eigen::Matrix3d frame;
  frame.col(0) << std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi), -std::sin(theta);
  frame.col(1) << -std::sin(phi), std::cos(phi), 0.0;
  frame.col(2) << std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta);
  return frame;
}

Line3d AxisGrid::axis(const Bin& bin) const {
  const Eigen::Matrix3d axes = frame(static_cast<std::size_t>(bin.theta) * num_phi_ + bin.phi);
  return {center_ + offset(bin.u) * axes.col(0) + offset(bin.v) * axes.col(1), axes.col(2)};
}

std::optional<AxisGrid::Bin> AxisGrid::find(const Line3d& axis) const {
  Eigen::Vector3d n = axis.direction().normalized();
  if (n.z() < 0.0) n = -n;
  const double phi = std::atan2(n.y(), n.x());
  const int t =
      std::clamp(static_cast<int>(std::acos(std::min(1.0, n.z())) / (0.5 * kPi) * num_theta_), 0, num_theta_ - 1);
  const int p =
      std::clamp(static_cast<int>((phi < 0.0 ? phi + 2.0 * kPi : phi) / (2.0 * kPi) * num_phi_), 0, num_phi_ - 1);
  const Eigen::Matrix3d axes = frame(static_cast<std::size_t>(t) * num_phi_ + p);
  Eigen::Vector3d foot = axis.origin() - center_;
  foot -= n.dot(foot) * n;
  const double u = axes.col(0).dot(foot), v = axes.col(1).dot(foot);
  if (std::max(std::abs(u), std::abs(v)) > radius_) return std::nullopt;
  const auto bin_of = [&](double x) {
    return std::clamp(static_cast<int>((x + radius_) / offsetStep()), 0, num_offset_ - 1);
  };
  return Bin{t, p, bin_of(u), bin_of(v)};
}

}  // namespace pcl_symmetry
