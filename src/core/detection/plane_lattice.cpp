#include "core/detection/plane_lattice.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/base/constants.h"
#include "core/detection/detection_rules.h"
#include "core/detection/plane_families.h"

namespace pcl_symmetry {

namespace {

/// Angle of the normal of a plane about a line, in [0, pi).
double angleAbout(const Line3d& line, const ReflectionPlane& plane) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  const double angle = std::atan2(plane.normal().dot(v), plane.normal().dot(u));
  return angle < 0.0 ? angle + kPi : angle;
}

/// The lattice of the planes that contain a line.
std::optional<PlaneLattice> latticeAbout(const Line3d& line, const std::vector<ReflectionPlane>& planes) {
  std::vector<double> angles;
  for (const ReflectionPlane& plane : planes)
    if (contains(plane, line, kDetection.families.contained_offset)) angles.push_back(angleAbout(line, plane));
  if (angles.size() < kDetection.families.least_planes) return std::nullopt;
  for (int fold = 3; fold <= kDetection.families.most_fold; ++fold) {
    std::complex<double> sum = 0.0;
    for (const double angle : angles) sum += std::polar(1.0, 2.0 * fold * angle);
    const double phase = std::arg(sum) / (2.0 * fold), step = kPi / fold;
    double most = 0.0;
    for (const double angle : angles) most = std::max(most, std::abs(std::remainder(angle - phase, step)));
    if (most > std::min(kDetection.families.most_folded * step, kDetection.families.most_off_angle)) continue;
    // Two of the angles give line and phase; each other one falls this close to a plane by chance, and the folds below
    // were tried before.
    const double by_chance = std::min(1.0, 2.0 * std::max(most, 0.25 * kDetection.families.most_folded * step) / step);
    const double chance = fold * std::pow(by_chance, static_cast<double>(angles.size()) - 1.0);
    if (chance > kDetection.families.most_chance) return std::nullopt;
    return PlaneLattice{line, fold, phase, static_cast<int>(angles.size())};
  }
  return std::nullopt;
}

}  // namespace

bool contains(const ReflectionPlane& plane, const Line3d& line, double tolerance) {
  return std::abs(plane.normal().dot(line.direction())) <= std::sin(kDetection.families.contained_angle) &&
         std::abs(plane.signedDistance(line.origin())) <= tolerance;
}

ReflectionPlane PlaneLattice::plane(double k) const {
  return planeThrough(line, phase + k * kPi / fold);
}

std::optional<PlaneLattice> findLattice(const std::vector<ReflectionPlane>& planes) {
  std::optional<PlaneLattice> best;
  const std::size_t size = std::min(planes.size(), kDetection.families.most_pairs);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (planes[i].angleTo(planes[j]) < kDetection.families.least_pair_angle) continue;
      Line3d line = commonLine({planes[i], planes[j]});
      std::vector<ReflectionPlane> through;
      for (const ReflectionPlane& plane : planes)
        if (contains(plane, line, kDetection.families.contained_offset)) through.push_back(plane);
      if (through.size() < kDetection.families.least_planes) continue;
      line = commonLine(through);
      const std::optional<PlaneLattice> lattice = latticeAbout(line, planes);
      if (lattice && (!best || lattice->num_planes > best->num_planes)) best = lattice;
    }
  return best;
}

}  // namespace pcl_symmetry
