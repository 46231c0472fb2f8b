#include "pcl_symmetry/core/plane_grid.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/symmetry_map.h"

namespace pcl_symmetry {

void MapSize::validate() const {
  check(num_theta >= 1 && num_theta <= 4096, "num_theta", num_theta, "in [1, 4096]");
  check(num_phi >= 2 && num_phi <= 4096 && num_phi % 2 == 0, "num_phi", num_phi, "even and in [2, 4096]");
  check(num_radius >= 1 && num_radius <= 4096, "num_radius", num_radius, "in [1, 4096]");
}

PlaneGrid::PlaneGrid(const MapSize& size, const Eigen::Vector3d& center, double radius)
    : num_theta_(size.num_theta),
      num_phi_(size.num_phi),
      num_radius_(size.num_radius),
      center_(center),
      radius_(radius) {
  size.validate();
  check(center.allFinite(), "center", center.transpose(), "finite");
  check(std::isfinite(radius) && radius > 0.0, "radius", radius, "finite and > 0");
  for (int t = 0; t < num_theta_; ++t) {
    const double width = phiStep() * std::sin(theta(t));
    phi_reach_.push_back(std::clamp(static_cast<int>(std::ceil(thetaStep() / width)), 1, num_phi_ / 2));
  }
}

double PlaneGrid::thetaStep() const {
  return 0.5 * kPi / num_theta_;
}
double PlaneGrid::phiStep() const {
  return 2.0 * kPi / num_phi_;
}
double PlaneGrid::radiusStep() const {
  return 2.0 * radius_ / num_radius_;
}

PlaneGrid::Bin PlaneGrid::bin(std::size_t index) const {
  const auto direction = index / num_radius_;
  return {static_cast<int>(direction / num_phi_), static_cast<int>(direction % num_phi_),
          static_cast<int>(index % num_radius_)};
}

Eigen::Vector3d PlaneGrid::normal(int t, int p) const {
  const double across = std::sin(theta(t));
  return {across * std::cos(phi(p)), across * std::sin(phi(p)), std::cos(theta(t))};
}

Eigen::Vector3d PlaneGrid::normal(std::size_t direction) const {
  return normal(static_cast<int>(direction / num_phi_), static_cast<int>(direction % num_phi_));
}

ReflectionPlane PlaneGrid::plane(const Bin& bin) const {
  const Eigen::Vector3d n = normal(bin.theta, bin.phi);
  return ReflectionPlane(n, n.dot(center_) + offset(bin.radius));
}

std::optional<PlaneGrid::Bin> PlaneGrid::find(const ReflectionPlane& plane) const {
  const ReflectionPlane c = plane.canonical();
  const Eigen::Vector3d& n = c.normal();
  const double r = c.offset() - n.dot(center_);
  if (std::abs(r) > radius_) return std::nullopt;
  const double angle = std::atan2(n.y(), n.x());
  const double wrapped = angle < 0.0 ? angle + 2.0 * kPi : angle;
  const double polar = std::atan2(std::hypot(n.x(), n.y()), n.z());
  return Bin{std::clamp(static_cast<int>(polar / thetaStep()), 0, num_theta_ - 1),
             std::clamp(static_cast<int>(wrapped / phiStep()), 0, num_phi_ - 1),
             std::clamp(static_cast<int>((r + radius_) / radiusStep()), 0, num_radius_ - 1)};
}

std::optional<PlaneGrid::Bin> PlaneGrid::step(const Bin& bin, int dt, int dp, int dk) const {
  Bin to{bin.theta + dt, bin.phi + dp, bin.radius + dk};
  if (to.radius < 0 || to.radius >= num_radius_) return std::nullopt;
  if (to.theta < 0) {
    to.theta = -1 - to.theta;
    to.phi += num_phi_ / 2;
  } else if (to.theta >= num_theta_) {
    to.theta = 2 * num_theta_ - 1 - to.theta;
    to.phi += num_phi_ / 2;
    to.radius = num_radius_ - 1 - to.radius;
  }
  to.phi = ((to.phi % num_phi_) + num_phi_) % num_phi_;
  return to;
}

SymmetryMap SymmetryMap::zero(const GaussianEdt& edt, const PlaneGrid& grid, TransformMethod method) {
  return {grid, std::vector<float>(grid.size(), 0.0f), method, edt.sigma(), grid.center()};
}

}  // namespace pcl_symmetry
