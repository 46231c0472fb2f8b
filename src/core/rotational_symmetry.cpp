#include "pcl_symmetry/core/rotational_symmetry.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "check.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/principal_axes.h"
#include "point_samples.h"
#include "rotation_fit.h"
#include "rotation_search.h"
#include "stopwatch.h"

namespace pcl_symmetry {

namespace {

constexpr double kGoldenRatio = 0.61803398874989485;
constexpr double kSameLine = 0.05;      // radians and radii
constexpr double kAcross = 0.1;         // radians from a right angle
constexpr double kMeets = 0.1;          // radians between angles of axes, found and of a group
constexpr double kRoughOverlap = 0.75;  // of a candidate before its fit
constexpr double kFairOverlap = 0.85;   // after it
constexpr double kRoughSupport = 0.85;
constexpr std::size_t kMostLines = 12;
constexpr int kTurns = 8;  // that stand for all turns about an axis

/// A group of rotations in place, in the normalised frame.
struct PlacedGroup {
  RotationGroupKind kind = RotationGroupKind::Cyclic;
  int fold = 1;
  RotationSet set;  ///< all but the identity; of continuous groups turns that stand for all
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  RotationEvidence evidence;
};

/// An axis with the turns about it that are symmetries.
struct FoundAxis {
  AxisLineCandidate line;
  int fold;  ///< 0: every turn
  PlacedGroup group;
};

double golden(int k) {
  return k * kGoldenRatio - std::floor(k * kGoldenRatio);
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

/// Turns about z that are in step with no polygon.
std::vector<Eigen::Matrix3d> turnsAbout(const Eigen::Vector3d& axis) {
  std::vector<Eigen::Matrix3d> turns;
  for (int k = 1; k <= kTurns; ++k) turns.push_back(rotationAbout(axis, 2.0 * M_PI * golden(k)));
  return turns;
}

Eigen::Vector3d axisOf(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(rotation).axis();
}

/// The frame whose z is along \p z and whose x is as near as can be to \p x.
Eigen::Matrix3d frameOf(const Eigen::Vector3d& z, const Eigen::Vector3d& x) {
  Eigen::Matrix3d frame;
  frame.col(2) = z.normalized();
  frame.col(1) = z.cross(x).normalized();
  frame.col(0) = frame.col(1).cross(frame.col(2));
  return frame;
}

class SymmetrySearch {
public:
  SymmetrySearch(const RotationFit& fit, const ObjectSymmetryOptions& options) : fit_(fit), options_(options) {}

  std::vector<AxisLineCandidate> candidates() const {
    const PrincipalAxes principal = principalAxes(fit_.points());
    std::vector<AxisLineCandidate> lines;
    for (int k = 0; k < 3; ++k) lines.push_back({principal.axes.col(k), principal.center});
    // Both lie on every axis: the center of mass, and that of the bounding ball, which is 0.
    if (principal.center.norm() > kSameLine) lines.push_back({principal.center.normalized(), principal.center});
    const auto found =
        searchAxes(fit_, principal.center, options_.num_directions, options_.max_fold, options_.num_threads);
    lines.insert(lines.end(), found.begin(), found.end());
    return lines;
  }

  /// Lines about which turns are symmetries, each once, those of the greatest order first.
  std::vector<FoundAxis> axes(const std::vector<AxisLineCandidate>& lines) const {
    std::vector<FoundAxis> found;
    for (const AxisLineCandidate& line : lines) {
      if (found.size() >= kMostLines || isKnown(found, line)) continue;
      std::optional<FoundAxis> axis = axisAt(line);
      if (axis && !isKnown(found, axis->line)) found.push_back(std::move(*axis));
    }
    std::stable_sort(found.begin(), found.end(), [](const FoundAxis& a, const FoundAxis& b) {
      return (a.fold == 0 ? 1000 : a.fold) > (b.fold == 0 ? 1000 : b.fold);
    });
    return found;
  }

  /// The greatest group that the axes are part of.
  PlacedGroup group(const std::vector<FoundAxis>& axes) const {
    if (axes.empty()) return {};
    const FoundAxis& main = axes.front();
    if (main.fold == 0) {
      if (auto sphere = spherical(axes)) return *sphere;
      if (auto cylinder = cylindrical(main)) return *cylinder;
      return main.group;
    }
    if (auto polyhedral = polyhedralGroup(axes)) return *polyhedral;
    for (const FoundAxis& axis : axes)
      if (auto dihedral = dihedralGroup(axis)) return *dihedral;
    return main.group;
  }

private:
  static bool isKnown(const std::vector<FoundAxis>& found, const AxisLineCandidate& line) {
    return std::any_of(found.begin(), found.end(), [&](const FoundAxis& axis) {
      const Eigen::Vector3d between = line.center - axis.line.center;
      return angleBetween(axis.line.direction, line.direction) < kSameLine &&
             between.cross(axis.line.direction).norm() < kSameLine;
    });
  }

  bool holds(const RotationEvidence& evidence) const {
    return evidence.confidence >= options_.min_confidence && evidence.feature <= options_.max_feature;
  }

  /// The set moved to where it fits best, if the surface bears it out.
  std::optional<PlacedGroup> placed(RotationGroupKind kind, int fold, RotationSet set) const {
    if (fit_.overlap(set) < kRoughOverlap) return std::nullopt;
    set = fit_.roughlyFitted(set);
    if (fit_.overlap(set) < kFairOverlap) return std::nullopt;
    set = fit_.closelyFitted(set);
    if (fit_.roughEvidence(set).support < kRoughSupport) return std::nullopt;
    const RotationEvidence evidence = fit_.evidence(set);
    if (!holds(evidence)) return std::nullopt;
    const Eigen::Vector3d axis = axisOf(set.rotations.front());
    return PlacedGroup{kind, fold, std::move(set), axis, evidence};
  }

  static RotationSet turnedTo(const Eigen::Matrix3d& frame, const Eigen::Vector3d& center, const RotationGroup& group) {
    RotationSet set{{}, center};
    for (const Eigen::Matrix3d& element : group.elements())
      if (!element.isIdentity(1e-9)) set.rotations.push_back(frame * element * frame.transpose());
    return set;
  }

  std::optional<FoundAxis> axisAt(const AxisLineCandidate& start) const {
    AxisLineCandidate line = start;
    const std::vector<int> likely = likelyFolds(fit_, line, options_.max_fold);
    if (likely.empty()) return std::nullopt;
    // One turn places the line well enough to tell others about it.
    const int first = likely.back();
    RotationSet turn{{rotationAbout(line.direction, 2.0 * M_PI / first)}, line.center};
    if (fit_.overlap(turn) < kLeastStart) return std::nullopt;
    turn = fit_.roughlyFitted(turn);
    if (fit_.overlap(turn) < kRoughOverlap) return std::nullopt;
    const Eigen::Vector3d direction = axisOf(turn.rotations[0]);
    line.center = turn.center + direction.dot(line.center - turn.center) * direction;
    line.direction = direction;
    if (auto revolution = placed(RotationGroupKind::Revolution, 0, {turnsAbout(line.direction), line.center}))
      return foundAt(*revolution);
    for (const int fold : likelyFolds(fit_, line, options_.max_fold)) {
      const RotationGroup group{RotationGroupKind::Cyclic, fold};
      const Eigen::Matrix3d frame = frameOf(line.direction, line.direction.unitOrthogonal());
      if (auto cyclic = placed(group.kind, fold, turnedTo(frame, line.center, group))) return foundAt(*cyclic);
    }
    return std::nullopt;
  }

  static FoundAxis foundAt(const PlacedGroup& group) {
    return {{group.axis, group.set.center}, group.kind == RotationGroupKind::Revolution ? 0 : group.fold, group};
  }

  std::optional<PlacedGroup> spherical(const std::vector<FoundAxis>& axes) const {
    if (axes.size() < 2 || axes[1].fold != 0) return std::nullopt;
    RotationSet set{turnsAbout(axes[0].line.direction), axes[0].line.center};
    const std::vector<Eigen::Matrix3d> others = turnsAbout(axes[1].line.direction);
    set.rotations.insert(set.rotations.end(), others.begin(), others.end());
    return placed(RotationGroupKind::Spherical, 0, set);
  }

  std::optional<PlacedGroup> cylindrical(const FoundAxis& main) const {
    std::vector<double> offsets;
    for (int k = -25; k <= 25; ++k) offsets.push_back(0.02 * k);
    const AxisLineCandidate across = bestAcross(fit_, main.line, M_PI, 1, offsets);
    RotationSet set{turnsAbout(main.line.direction), across.center};
    set.rotations.push_back(rotationAbout(across.direction, M_PI));
    return placed(RotationGroupKind::Cylindrical, 0, set);
  }

  std::optional<PlacedGroup> dihedralGroup(const FoundAxis& main) const {
    const RotationGroup group{RotationGroupKind::Dihedral, main.fold};
    const double width = M_PI / main.fold;
    const int num_angles = std::max(4, static_cast<int>(std::ceil(width / 0.02)));
    const AxisLineCandidate across =
        bestAcross(fit_, main.line, width, num_angles, {0.0, -0.04, 0.04, -0.08, 0.08, -0.12, 0.12});
    const Eigen::Matrix3d frame = frameOf(main.line.direction, across.direction);
    return placed(group.kind, main.fold, turnedTo(frame, across.center, group));
  }

  std::optional<PlacedGroup> polyhedralGroup(const std::vector<FoundAxis>& axes) const {
    for (const RotationGroup& group : {RotationGroup{RotationGroupKind::Icosahedral, 5},
                                       RotationGroup{RotationGroupKind::Octahedral, 4},
                                       RotationGroup{RotationGroupKind::Tetrahedral, 3}})
      if (auto found = polyhedralGroup(axes, group)) return found;
    return std::nullopt;
  }

  /// Two axes that are not parallel place a group, up to itself.
  std::optional<PlacedGroup> polyhedralGroup(const std::vector<FoundAxis>& axes, const RotationGroup& group) const {
    const std::vector<RotationAxis> own = axesOf(group.elements());
    for (std::size_t i = 0; i < axes.size(); ++i) {
      for (std::size_t j = i + 1; j < axes.size(); ++j) {
        for (const RotationAxis& a : own) {
          for (const RotationAxis& b : own) {
            for (const double sign : {1.0, -1.0}) {
              if (a.order % axes[i].fold != 0 || b.order % axes[j].fold != 0) continue;
              const Eigen::Vector3d second = sign * axes[j].line.direction;
              const double between = std::acos(std::clamp(axes[i].line.direction.dot(second), -1.0, 1.0));
              const double expected = std::acos(std::clamp(a.direction.dot(b.direction), -1.0, 1.0));
              if (expected < kAcross || expected > M_PI - kAcross || std::abs(between - expected) > kMeets) continue;
              const Eigen::Matrix3d frame =
                  frameOf(axes[i].line.direction, second) * frameOf(a.direction, b.direction).transpose();
              if (auto found = placed(group.kind, group.fold, turnedTo(frame, axes[i].line.center, group)))
                return found;
            }
          }
        }
      }
    }
    return std::nullopt;
  }

  static constexpr double kLeastStart = 0.5;

  const RotationFit& fit_;
  const ObjectSymmetryOptions& options_;
};

/// A normalised group in the input frame.
ObjectSymmetries inInputFrame(const PlacedGroup& group, const BoundingBall& ball) {
  ObjectSymmetries result;
  result.kind = group.kind;
  result.fold = group.fold;
  result.center = ball.center + ball.radius * group.set.center;
  if (group.kind == RotationGroupKind::Cyclic && group.fold == 1) return result;
  result.support = group.evidence.support;
  result.confidence = group.evidence.confidence;
  const auto motion = [&](const Eigen::Matrix3d& rotation) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = rotation;
    T.translation() = result.center - rotation * result.center;
    return T;
  };
  if (group.kind == RotationGroupKind::Spherical) {
    for (int k = 0; k < 3; ++k) result.continuous.push_back({Eigen::Vector3d::Unit(k), result.center});
  } else if (isContinuous(group.kind)) {
    result.continuous.push_back({group.axis, result.center});
    if (group.kind == RotationGroupKind::Cylindrical) result.discrete.push_back(motion(group.set.rotations.back()));
  } else {
    for (const Eigen::Matrix3d& rotation : group.set.rotations) result.discrete.push_back(motion(rotation));
  }
  return result;
}

}  // namespace

void ObjectSymmetryOptions::validate() const {
  check(num_cells >= 8 && num_cells <= 512, "num_cells", num_cells, "in [8, 512]");
  check(num_directions >= 100, "num_directions", num_directions, ">= 100");
  check(max_fold >= 2, "max_fold", max_fold, ">= 2");
  check(max_points >= 100, "max_points", max_points, ">= 100");
  check(max_feature >= 0.0 && max_feature <= 1.0, "max_feature", max_feature, "in [0, 1]");
  check(min_confidence >= 0.0 && min_confidence <= 1.0, "min_confidence", min_confidence, "in [0, 1]");
  checkNumThreads(num_threads);
}

ObjectSymmetries objectSymmetries(const PointsRef& points, const ObjectSymmetryOptions& options) {
  options.validate();
  check(points.cols() >= 1, "number of points", points.cols(), ">= 1");
  check(points.allFinite(), "points", "not finite", "finite");
  Stopwatch watch;
  const Points used = pointsAt(points, drawSamples(points.cols(), options.max_points, options.seed));
  const BoundingBall ball = boundingBall(used);
  check(ball.radius > 0.0, "extent of the points", ball.radius, "> 0");
  const Points normalized = normalizePoints(used, ball.center, ball.radius);
  GaussianEdtOptions edt_options;
  edt_options.num_cells = options.num_cells;
  edt_options.num_threads = options.num_threads;
  const GaussianEdt edt(normalized, edt_options);
  const RotationFit fit(normalized, edt, options.seed, options.num_threads);
  std::vector<std::pair<std::string, double>> timing_ms{{"surface", watch.lap()}};
  const SymmetrySearch search(fit, options);
  const std::vector<AxisLineCandidate> lines = search.candidates();
  timing_ms.emplace_back("search", watch.lap());
  const std::vector<FoundAxis> axes = search.axes(lines);
  timing_ms.emplace_back("axes", watch.lap());
  const PlacedGroup group = search.group(axes);
  timing_ms.emplace_back("group", watch.lap());
  ObjectSymmetries result = inInputFrame(group, ball);
  result.timing_ms = std::move(timing_ms);
  return result;
}

}  // namespace pcl_symmetry
