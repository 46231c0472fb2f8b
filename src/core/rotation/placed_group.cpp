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

// Turns that stand for all turns about an axis. chosen: half takes polygons for round, twice takes twice the time.
constexpr int kNumTurns = 8;
// Rotations that stand for all rotations. chosen: half takes polyhedra for balls, twice takes twice the time.
constexpr int kNumSphereTurns = 16;
// Relative difference of equal matrices. derived: far above rounding, far below the difference of two elements.
constexpr double kSameElement = 1e-9;
// Excess of the worst of the rotations that stand for all, whose mean may be 1. chosen: at 1 chance decides between
// angles that all fail a little, at 1.5 a polygon of a dozen sides is round.
constexpr double kWorstOfAll = 1.25;
// Standard errors, and share, that a share of some of the points may be off by. derived: one in a thousand is; chosen:
// the close fit gains about the latter.
constexpr double kErrors = 3.0, kGainOfFit = 0.03;
// Others fail by this factor more, and by this much of what is allowed. chosen: at 1 and 0 folds of round bodies are
// chance, at twice true folds beside features are lost.
constexpr double kClearFactor = 1.5, kClearExcess = 0.2;

bool standsForAll(RotationGroupKind kind) {
  return kind == RotationGroupKind::Revolution || kind == RotationGroupKind::Spherical;
}

/// The mean of rotations that stand for all, or nothing where one of them fails clearly. Their worst would be a matter
/// of chance.
std::optional<OffShares> meanShares(const RotationFit& fit, const RotationSet& set) {
  OffShares mean;
  for (std::size_t i = 0; i < set.num_judged; ++i) {
    const OffShares shares = fit.offShares(set.rotations[i], set.center);
    if (fit.limits().excess(shares) > kWorstOfAll) return std::nullopt;
    mean.off += shares.off / static_cast<double>(set.num_judged);
    mean.far += shares.far / static_cast<double>(set.num_judged);
  }
  return mean;
}

}  // namespace

double greatestExcess(const RotationLimits& limits, int num_samples) {
  const double phi = std::max(limits.max_feature, 1e-3);  // derived: avoids a division by 0
  return 1.0 + (kGainOfFit + kErrors * std::sqrt(phi / num_samples)) / phi;
}

bool beatsOthers(double excess, double others) {
  return others >= kClearFactor * excess && others >= excess + kClearExcess;
}

std::optional<PlacedGroup> placedGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                       RotationGroupKind kind, int fold, RotationSet set) {
  if (fit.overlap(set) < kRoughOverlap) return std::nullopt;
  set = fit.roughlyFitted(set);
  if (fit.overlap(set) < kFairOverlap) return std::nullopt;
  set = fit.closelyFitted(set);
  const double some = greatestExcess(fit.limits(), kSomeSamples);
  if (fit.limits().excess(fit.worstShares(set, kSomeSamples, some)) > some) return std::nullopt;
  const std::optional<OffShares> shares =
      standsForAll(kind) ? meanShares(fit, set)
                         : fit.worstShares(set, std::numeric_limits<int>::max(), 1.0 / options.min_confidence);
  if (!shares || fit.confidence(*shares) < options.min_confidence) return std::nullopt;
  const Eigen::Vector3d axis = axisOf(set.rotations.front());
  return PlacedGroup{kind, fold, std::move(set), axis, *shares};
}

Eigen::Matrix3d frameAlong(const Eigen::Vector3d& z, const Eigen::Vector3d& x) {
  Eigen::Matrix3d frame;
  frame.col(2) = z.normalized();
  frame.col(1) = z.cross(x).normalized();
  frame.col(0) = frame.col(1).cross(frame.col(2));
  return frame;
}

Eigen::Vector3d axisOf(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(rotation).axis();
}

RotationSet elementsOf(const RotationGroup& group, const Eigen::Matrix3d& frame, const Eigen::Vector3d& center) {
  std::vector<Eigen::Matrix3d> judged = group.generators();
  const bool about_z = group.kind == RotationGroupKind::Cyclic || group.kind == RotationGroupKind::Dihedral;
  for (const int step : {group.fold / 4, group.fold / 2})
    if (about_z && step > 1) judged.push_back(rotationAbout(Eigen::Vector3d::UnitZ(), 2.0 * kPi * step / group.fold));
  RotationSet set{{}, center, judged.size()};
  for (const Eigen::Matrix3d& rotation : judged) set.rotations.push_back(frame * rotation * frame.transpose());
  for (const Eigen::Matrix3d& element : group.elements()) {
    const bool listed = std::any_of(judged.begin(), judged.end(), [&](const Eigen::Matrix3d& other) {
      return element.isApprox(other, kSameElement);
    });
    if (!listed && !element.isIdentity(kSameElement)) set.rotations.push_back(frame * element * frame.transpose());
  }
  return set;
}

RotationSet cyclicSet(const Line3d& line, int fold) {
  const Eigen::Matrix3d frame = frameAlong(line.direction(), line.direction().unitOrthogonal());
  return elementsOf(RotationGroup{RotationGroupKind::Cyclic, fold}, frame, line.origin());
}

RotationSet singleTurn(const Line3d& line, int fold) {
  return {{rotationAbout(line.direction(), 2.0 * kPi / fold)}, line.origin(), 1};
}

RotationSet turnsAbout(const Line3d& line) {
  RotationSet set{{}, line.origin(), static_cast<std::size_t>(kNumTurns)};
  for (int k = 1; k <= kNumTurns; ++k)
    set.rotations.push_back(rotationAbout(line.direction(), 2.0 * kPi * goldenFraction(k)));
  return set;
}

RotationSet turnsOfSphere(const Eigen::Vector3d& center) {
  RotationSet set{{}, center, static_cast<std::size_t>(kNumSphereTurns)};
  for (int k = 0; k < kNumSphereTurns; ++k) {
    const double angle = 2.0 * kPi / 3.0 + kPi / 3.0 * goldenFraction(k);
    set.rotations.push_back(rotationAbout(spiralDirection(k, kNumSphereTurns, kGoldenAngle * k), angle));
  }
  return set;
}

}  // namespace pcl_symmetry
