#include "core/rotation/placed_group.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "core/base/constants.h"
#include "core/geometry/directions.h"

namespace pcl_symmetry {

namespace {

// Turns that stand for all turns about an axis. chosen: half takes polygons for round, twice takes twice the time.
constexpr int kNumTurns = 8;
// Relative difference of equal matrices. derived: far above rounding, far below the difference of two elements.
constexpr double kSameElement = 1e-9;

}  // namespace

bool holds(const RotationEvidence& evidence, const ObjectSymmetryOptions& options) {
  return evidence.confidence >= options.min_confidence && evidence.feature <= options.max_feature;
}

std::optional<PlacedGroup> placedGroup(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                       RotationGroupKind kind, int fold, RotationSet set) {
  if (fit.overlap(set) < kRoughOverlap) return std::nullopt;
  set = fit.roughlyFitted(set);
  if (fit.overlap(set) < kFairOverlap || fit.roughSupport(set) < kFairSupport) return std::nullopt;
  set = fit.closelyFitted(set);
  const RotationEvidence evidence = fit.evidence(set);
  if (!holds(evidence, options)) return std::nullopt;
  const Eigen::Vector3d axis = axisOf(set.rotations.front());
  return PlacedGroup{kind, fold, std::move(set), axis, evidence};
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

RotationSet cyclicSet(const AxisLineCandidate& line, int fold) {
  const Eigen::Matrix3d frame = frameAlong(line.direction, line.direction.unitOrthogonal());
  return elementsOf(RotationGroup{RotationGroupKind::Cyclic, fold}, frame, line.center);
}

RotationSet singleTurn(const AxisLineCandidate& line, int fold) {
  return {{rotationAbout(line.direction, 2.0 * kPi / fold)}, line.center, 1};
}

RotationSet turnsAbout(const AxisLineCandidate& line) {
  RotationSet set{{}, line.center, static_cast<std::size_t>(kNumTurns)};
  for (int k = 1; k <= kNumTurns; ++k)
    set.rotations.push_back(rotationAbout(line.direction, 2.0 * kPi * goldenFraction(k)));
  return set;
}

}  // namespace pcl_symmetry
