/// The greatest group that contains axes of symmetry.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/constants.h"
#include "core/geometry/directions.h"
#include "core/rotation/rotation_axes.h"

namespace pcl_symmetry {

namespace {

/// Rotations about a center that represent all rotations: axes in all directions, angles from 120 to 180 degrees.
RotationSet rotationsOfSphere(const Eigen::Vector3d& center) {
  const int num_rotations = 16;  // fewer mistake polyhedra for balls
  RotationSet set{{}, center, static_cast<std::size_t>(num_rotations)};
  for (int k = 0; k < num_rotations; ++k) {
    const double angle = 2.0 * kPi / 3.0 + kPi / 3.0 * goldenFraction(k);
    set.rotations.push_back(rotationAbout(spiralDirection(k, num_rotations, kGoldenAngle * k), angle));
  }
  return set;
}

/// The group of a sphere. Rotations about axes in all directions have to fit: two axes of revolution could be one.
std::optional<PlacedGroup> sphericalGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                          const PlacedGroup& main) {
  // The center is the point of the axis nearest to the mean of the samples.
  const Eigen::Vector3d mass = centerOfMass(fit.points());
  const Eigen::Vector3d center =
      main.line().origin() + main.line().direction().dot(mass - main.line().origin()) * main.line().direction();
  return placedGroup(fit, options, RotationGroupKind::Spherical, 0, rotationsOfSphere(center));
}

std::optional<PlacedGroup> cylindricalGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                            const PlacedGroup& main) {
  std::vector<double> offsets;
  // Up to half the radius: if points are unevenly dense, the center of a cylinder lies off the center of mass.
  const int num_steps = static_cast<int>(std::lround(0.5 / kRotation.across_step));
  for (int k = -num_steps; k <= num_steps; ++k) offsets.push_back(kRotation.across_step * k);
  const Line3d across = bestAcross(fit, main.line(), kPi, 1, offsets);
  RotationSet set = rotationsAbout({across.origin(), main.line().direction()});
  set.rotations.insert(set.rotations.begin() + 1, rotationAbout(across.direction(), kPi));
  set.num_judged = 2;
  return placedGroup(fit, options, RotationGroupKind::Cylindrical, 0, set);
}

std::optional<PlacedGroup> dihedralGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                         const PlacedGroup& main) {
  const RotationGroup group{RotationGroupKind::Dihedral, main.fold};
  const double width = kPi / main.fold;
  const int num_angles = std::max(4, static_cast<int>(std::ceil(width / kRotation.across_step)));
  std::vector<double> offsets{0.0};  // nearest first
  for (int k = 1; k <= 3; ++k)
    for (const double way : {-2.0, 2.0}) offsets.push_back(way * k * kRotation.across_step);
  const Line3d across = bestAcross(fit, main.line(), width, num_angles, offsets);
  const auto placed = [&](const Eigen::Vector3d& direction) {
    const Eigen::Matrix3d frame = frameAlong(main.line().direction(), direction);
    return placedGroup(fit, options, group.kind, main.fold, elementsOf(group, frame, across.origin()));
  };
  if (auto found = placed(across.direction())) return found;
  // In the cells of a slender part, all angles look alike; its surface distinguishes them, within less than the
  // tolerance.
  constexpr double kSharp = 0.25;
  const RotationFit sharp = fit.withLimits({kSharp * fit.limits().tolerance, options.max_feature});
  double least = std::numeric_limits<double>::infinity();
  Eigen::Vector3d best = across.direction();
  for (int k = 0; k < num_angles; ++k) {
    const Eigen::Vector3d direction =
        rotationAbout(main.line().direction(), width * k / num_angles) * across.direction();
    const OffShares shares = sharp.offShares(rotationAbout(direction, kPi), across.origin(), kRotation.num_some_points);
    if (!(shares.off < least)) continue;
    least = shares.off;
    best = direction;
  }
  return placed(best);
}

/// Two axes that are not parallel determine the position of a group, up to its own symmetry.
/// \param first,second axes that were found.
/// \param a,b axes of the group with which they are identified.
std::optional<PlacedGroup> groupThrough(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                        const RotationGroup& group, const PlacedGroup& first, const PlacedGroup& second,
                                        const RotationAxis& a, const RotationAxis& b) {
  if (a.order % first.fold != 0 || b.order % second.fold != 0) return std::nullopt;
  const double cosine = a.direction.dot(b.direction);
  const Eigen::Vector3d direction = first.line().direction().dot(second.line().direction()) * cosine < 0.0
                                        ? -second.line().direction()
                                        : second.line().direction();
  const double expected = angleBetweenLines(a.direction, b.direction);
  if (expected < kRotation.axes_meet ||
      std::abs(angleBetweenLines(first.line().direction(), direction) - expected) > kRotation.axes_meet)
    return std::nullopt;
  const Eigen::Matrix3d frame =
      frameAlong(first.line().direction(), direction) * frameAlong(a.direction, b.direction).transpose();
  return placedGroup(fit, options, group.kind, group.fold, elementsOf(group, frame, first.line().origin()));
}

std::optional<PlacedGroup> polyhedralGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                           const RotationGroup& group, const std::vector<PlacedGroup>& axes) {
  const std::vector<RotationAxis> own = axesOf(group.elements());
  // Axes of one order are images of each other, so that one axis of each order represents `first`.
  std::vector<RotationAxis> firsts;
  for (const RotationAxis& axis : own)
    if (std::none_of(firsts.begin(), firsts.end(), [&](const RotationAxis& a) { return a.order == axis.order; }))
      firsts.push_back(axis);
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (std::size_t j = i + 1; j < axes.size(); ++j)
      for (const RotationAxis& a : firsts)
        for (const RotationAxis& b : own)
          if (auto found = groupThrough(fit, options, group, axes[i], axes[j], a, b)) return found;
  return std::nullopt;
}

/// The greatest group with axes of finite order: the regular solids, then prisms, then the rotations about one axis.
PlacedGroup finiteGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                        const std::vector<PlacedGroup>& axes) {
  for (const RotationGroup& group : kPolyhedralGroups)
    if (auto solid = polyhedralGroup(fit, options, group, axes)) return *solid;
  for (const PlacedGroup& axis : axes) {
    // A dihedral group about this axis would have no more elements than the rotations about the main axis.
    if (2 * axis.fold <= axes.front().fold) break;
    if (auto prism = dihedralGroup(fit, options, axis)) return *prism;
  }
  return axes.front();
}

}  // namespace

PlacedGroup greatestGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                          const std::vector<PlacedGroup>& axes) {
  if (axes.empty()) return {};
  if (axes.front().fold != 0) return finiteGroup(fit, options, axes);
  if (auto sphere = sphericalGroup(fit, options, axes.front())) return *sphere;
  if (auto cylinder = cylindricalGroup(fit, options, axes.front())) return *cylinder;
  return axes.front();
}

}  // namespace pcl_symmetry
