#include "core/rotation/placed_group.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/constants.h"
#include "core/geometry/directions.h"

namespace pcl_symmetry {

namespace {

/// The mean shares of rotations that represent all rotations; nothing if one of them fails clearly. The worst one would
/// be a matter of chance.
std::optional<OffShares> meanShares(const RotationFit& fit, const RotationSet& set) {
  OffShares mean;
  for (std::size_t i = 0; i < set.num_judged; ++i) {
    const OffShares shares = fit.offShares(set.rotations[i], set.center);
    if (fit.limits().excess(shares) > kRotation.max_worst) return std::nullopt;
    mean.off += shares.off / static_cast<double>(set.num_judged);
    mean.far += shares.far / static_cast<double>(set.num_judged);
  }
  return mean;
}

}  // namespace

double greatestExcess(const RotationLimits& limits) {
  const double phi = std::max(limits.max_feature, 1e-3);
  return 1.0 + (kRotation.gain_of_fit + kRotation.max_errors * std::sqrt(phi / kRotation.num_some_points)) / phi;
}

std::optional<PlacedGroup> placedGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                       RotationGroupKind kind, int fold, RotationSet set) {
  if (fit.overlap(set) < kRotation.rough_overlap) return std::nullopt;
  set = fit.fitRoughly(set);
  if (fit.overlap(set) < kRotation.fair_overlap) return std::nullopt;
  set = fit.fitClosely(set);
  const double some = greatestExcess(fit.limits());
  if (fit.limits().excess(fit.worstShares(set, kRotation.num_some_points, some)) > some) return std::nullopt;
  const bool represents_all = kind == RotationGroupKind::Revolution || kind == RotationGroupKind::Spherical;
  const std::optional<OffShares> shares =
      represents_all ? meanShares(fit, set)
                     : fit.worstShares(set, std::numeric_limits<int>::max(), 1.0 / options.min_confidence);
  if (!shares || fit.confidence(*shares) < options.min_confidence) return std::nullopt;
  const Eigen::Vector3d axis = Eigen::AngleAxisd(set.rotations.front()).axis();
  return PlacedGroup{kind, fold, std::move(set), axis, *shares};
}

Eigen::Matrix3d frameAlong(const Eigen::Vector3d& z, const Eigen::Vector3d& x) {
  Eigen::Matrix3d frame;
  frame.col(2) = z.normalized();
  frame.col(1) = z.cross(x).normalized();
  frame.col(0) = frame.col(1).cross(frame.col(2));
  return frame;
}

std::vector<Eigen::Matrix3d> productsOf(const std::vector<Eigen::Matrix3d>& generators, double same,
                                        std::size_t max_count) {
  std::vector<Eigen::Matrix3d> elements{Eigen::Matrix3d::Identity()};
  for (std::size_t i = 0; i < elements.size() && elements.size() <= max_count; ++i) {
    for (const Eigen::Matrix3d& generator : generators) {
      const Eigen::Matrix3d product = generator * elements[i];
      if (std::none_of(elements.begin(), elements.end(),
                       [&](const Eigen::Matrix3d& other) { return (other - product).norm() < same; }))
        elements.push_back(product);
    }
  }
  return elements;
}

RotationSet elementsOf(const RotationGroup& group, const Eigen::Matrix3d& frame, const Eigen::Vector3d& center) {
  std::vector<Eigen::Matrix3d> judged = group.generators();
  const bool about_z = group.kind == RotationGroupKind::Cyclic || group.kind == RotationGroupKind::Dihedral;
  for (const int step : {group.fold / 4, group.fold / 2})
    if (about_z && step > 1) judged.push_back(rotationAbout(Eigen::Vector3d::UnitZ(), 2.0 * kPi * step / group.fold));
  RotationSet set{{}, center, judged.size()};
  for (const Eigen::Matrix3d& rotation : judged) set.rotations.push_back(frame * rotation * frame.transpose());
  for (const Eigen::Matrix3d& element : group.elements()) {
    const bool listed = std::any_of(judged.begin(), judged.end(),
                                    [&](const Eigen::Matrix3d& other) { return element.isApprox(other, 1e-9); });
    if (!listed && !element.isIdentity(1e-9)) set.rotations.push_back(frame * element * frame.transpose());
  }
  return set;
}

RotationSet rotationsAbout(const Line3d& line) {
  const int num_rotations = 8;  // fewer mistake polygons for circles
  RotationSet set{{}, line.origin(), static_cast<std::size_t>(num_rotations)};
  for (int k = 1; k <= num_rotations; ++k)
    set.rotations.push_back(rotationAbout(line.direction(), 2.0 * kPi * goldenFraction(k)));
  return set;
}

}  // namespace pcl_symmetry
