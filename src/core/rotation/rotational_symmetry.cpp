#include "pcl_symmetry/core/rotation/rotational_symmetry.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/check.h"
#include "core/base/stopwatch.h"
#include "core/neighbours/distinct_points.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/principal_axes.h"
#include "core/rotation/rotation_fit.h"
#include "core/rotation/rotation_search.h"
#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

constexpr double kGoldenRatio = 0.61803398874989485;
constexpr double kSameLine = 0.05;         // radians and radii
constexpr double kMeets = 0.1;             // radians between angles of axes, found and of a group
constexpr double kLeastOverlap = 0.5;      // of a line before its fit
constexpr double kRoughOverlap = 0.75;     // of a group before it
constexpr double kFairOverlap = 0.85;      // after it
constexpr double kLeastSupport = 0.6;      // of a line that has been placed roughly
constexpr double kRoughSupport = 0.85;     // of what goes on to be judged
constexpr Eigen::Index kLeastPoints = 20;  // fewer show no surface
constexpr double kLeastWidth = 1e-10;      // of a variance, the greatest: less is a line
constexpr std::size_t kMostLines = 12;
constexpr double kAllowance = 0.015;  // of the support, from the best turn to all turns, as of planes
constexpr int kTurns = 8;             // that stand for all turns about an axis

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

/// Turns about an axis that are in step with no polygon.
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

  /// Through the center of mass, and where the points are unevenly dense through that of their bounding ball, which is
  /// 0: both lie on every axis of a shape.
  std::vector<AxisLineCandidate> candidates() const {
    const PrincipalAxes principal = principalAxes(fit_.points());
    std::vector<AxisLineCandidate> lines;
    std::vector<Eigen::Vector3d> centers{principal.center};
    if (principal.center.norm() > kSameLine) {
      lines.push_back({principal.center.normalized(), principal.center});
      centers.push_back(Eigen::Vector3d::Zero());
    }
    for (const Eigen::Vector3d& center : centers) {
      for (int k = 0; k < 3; ++k) lines.push_back({principal.axes.col(k), center});
      const auto found = searchAxes(fit_, center, options_.num_directions, options_.max_fold, options_.num_threads);
      lines.insert(lines.end(), found.begin(), found.end());
    }
    return lines;
  }

  /// Lines about which turns are symmetries, each once, those of the greatest order first; two continuous ones, or one
  /// and no others, tell all.
  std::vector<FoundAxis> axes(const std::vector<AxisLineCandidate>& lines) const {
    std::vector<FoundAxis> found;
    std::vector<AxisLineCandidate> tried;
    for (const AxisLineCandidate& start : lines) {
      const bool continuous = !found.empty() && found.front().fold == 0;
      if (found.size() >= (continuous ? 2 : kMostLines)) break;
      if (isKnown(tried, start)) continue;
      const std::optional<AxisLineCandidate> line = fittedLine(start);
      if (!line || isKnown(tried, *line)) continue;
      tried.push_back(*line);
      std::optional<FoundAxis> axis = revolutionAbout(*line);
      if (!continuous && (!axis || axis->group.evidence.support < 1.0 - kAllowance)) {
        std::optional<FoundAxis> cyclic = cyclicAbout(*line);
        if (cyclic && (!axis || isBetter(*cyclic, *axis))) axis = std::move(cyclic);
      }
      if (!axis) continue;
      if (axis->fold == 0 && !continuous) found.clear();
      found.push_back(std::move(*axis));
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const FoundAxis& a, const FoundAxis& b) { return a.fold > b.fold; });
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
    for (const FoundAxis& axis : axes) {
      if (2 * axis.fold <= main.fold) break;
      if (auto dihedral = dihedralGroup(axis)) return *dihedral;
    }
    return main.group;
  }

private:
  static bool isKnown(const std::vector<AxisLineCandidate>& lines, const AxisLineCandidate& line) {
    return std::any_of(lines.begin(), lines.end(), [&](const AxisLineCandidate& other) {
      return angleBetween(other.direction, line.direction) < kSameLine &&
             (line.center - other.center).cross(other.direction).norm() < kSameLine;
    });
  }

  /// Whether the turns by one angle map clearly more onto the surface than all turns: a slender prism is not round.
  static bool isBetter(const FoundAxis& cyclic, const FoundAxis& revolution) {
    return cyclic.group.evidence.support > revolution.group.evidence.support + kAllowance;
  }

  bool holds(const RotationEvidence& evidence) const {
    return evidence.confidence >= options_.min_confidence && evidence.feature <= options_.max_feature;
  }

  /// The set moved to where it fits best, if the surface bears it out.
  std::optional<PlacedGroup> placed(RotationGroupKind kind, int fold, RotationSet set) const {
    if (fit_.overlap(set) < kRoughOverlap) return std::nullopt;
    set = fit_.roughlyFitted(set);
    if (fit_.overlap(set) < kFairOverlap || fit_.roughSupport(set) < kRoughSupport) return std::nullopt;
    set = fit_.closelyFitted(set);
    const RotationEvidence evidence = fit_.evidence(set);
    if (!holds(evidence)) return std::nullopt;
    const Eigen::Vector3d axis = axisOf(set.rotations.front());
    return PlacedGroup{kind, fold, std::move(set), axis, evidence};
  }

  /// All elements but the identity. Judged are the generators and, as one step cannot be told from that of one fold
  /// more or less where there are many, the turns of about a quarter and a half.
  static RotationSet turnedTo(const Eigen::Matrix3d& frame, const Eigen::Vector3d& center, const RotationGroup& group) {
    std::vector<Eigen::Matrix3d> first = group.generators();
    const bool about_z = group.kind == RotationGroupKind::Cyclic || group.kind == RotationGroupKind::Dihedral;
    for (const int step : {group.fold / 4, group.fold / 2})
      if (about_z && step > 1) first.push_back(rotationAbout(Eigen::Vector3d::UnitZ(), 2.0 * M_PI * step / group.fold));
    RotationSet set{{}, center, first.size()};
    for (const Eigen::Matrix3d& rotation : first) set.rotations.push_back(frame * rotation * frame.transpose());
    for (const Eigen::Matrix3d& element : group.elements()) {
      const bool listed = std::any_of(first.begin(), first.end(),
                                      [&](const Eigen::Matrix3d& other) { return element.isApprox(other, 1e-9); });
      if (!listed && !element.isIdentity(1e-9)) set.rotations.push_back(frame * element * frame.transpose());
    }
    return set;
  }

  static RotationSet cyclicSet(const AxisLineCandidate& line, int fold) {
    const Eigen::Matrix3d frame = frameOf(line.direction, line.direction.unitOrthogonal());
    return turnedTo(frame, line.center, RotationGroup{RotationGroupKind::Cyclic, fold});
  }

  static RotationSet turnsOf(const AxisLineCandidate& line) {
    return {turnsAbout(line.direction), line.center, static_cast<std::size_t>(kTurns)};
  }

  static RotationSet turnOf(const AxisLineCandidate& line, int fold) {
    return {{rotationAbout(line.direction, 2.0 * M_PI / fold)}, line.center, 1};
  }

  /// The line moved to where its likeliest turn fits best.
  std::optional<AxisLineCandidate> fittedLine(const AxisLineCandidate& start) const {
    RotationSet turn = turnOf(start, likeliestFold(fit_, start, options_.max_fold));
    if (fit_.overlap(turn) < kLeastOverlap) return std::nullopt;
    turn = fit_.roughlyFitted(turn);
    if (fit_.overlap(turn) < kRoughOverlap || fit_.roughSupport(turn) < kLeastSupport) return std::nullopt;
    turn = fit_.closelyFitted(turn);
    if (fit_.overlap(turn) < kFairOverlap) return std::nullopt;
    const Eigen::Vector3d direction = axisOf(turn.rotations[0]);
    return AxisLineCandidate{direction, turn.center + direction.dot(start.center - turn.center) * direction};
  }

  std::optional<FoundAxis> revolutionAbout(const AxisLineCandidate& line) const {
    auto group = placed(RotationGroupKind::Revolution, 0, turnsOf(line));
    if (!group) return std::nullopt;
    const AxisLineCandidate fitted{group->axis, group->set.center};
    return FoundAxis{fitted, 0, std::move(*group)};
  }

  /// The greatest cyclic group about a line.
  std::optional<FoundAxis> cyclicAbout(const AxisLineCandidate& line) const {
    const int fold = foldOf(line);
    if (fold == 1) return std::nullopt;
    auto group = placed(RotationGroupKind::Cyclic, fold, cyclicSet(line, fold));
    if (!group) return std::nullopt;
    const AxisLineCandidate fitted{group->axis, group->set.center};
    return FoundAxis{fitted, fold, std::move(*group)};
  }

  /// The n of which the turns by 2 pi / n and by its multiples are symmetries. Of two of which none divides the other
  /// the surer one: what is both is round.
  int foldOf(const AxisLineCandidate& line) const {
    std::vector<double> confidence(static_cast<std::size_t>(options_.max_fold) + 1, 0.0);
    confidence[1] = 0.01;
    std::vector<int> folds{1};
    for (const int n : likelyFolds(fit_, line, options_.max_fold)) {
      bool parts = true;
      for (int part = 1; part < n; ++part) parts &= n % part != 0 || confidence[part] > 0.0;
      if (!parts) continue;
      RotationSet turns = cyclicSet(line, n);
      if (fit_.roughSupport(turns) < kRoughSupport) continue;
      const std::size_t num_judged = std::exchange(turns.num_judged, 1);  // one is quicker, and mostly enough
      RotationEvidence evidence = fit_.evidence(turns);
      turns.num_judged = num_judged;
      if (holds(evidence) && num_judged > 1) evidence = fit_.evidence(turns);
      if (!holds(evidence)) continue;
      confidence[n] = evidence.confidence;
      folds.erase(std::remove_if(folds.begin(), folds.end(), [&](int part) { return n % part == 0; }), folds.end());
      folds.push_back(n);
    }
    return *std::max_element(folds.begin(), folds.end(), [&](int a, int b) { return confidence[a] < confidence[b]; });
  }

  std::optional<PlacedGroup> spherical(const std::vector<FoundAxis>& axes) const {
    if (axes.size() < 2) return std::nullopt;
    RotationSet set = turnsOf(axes[0].line);
    const std::vector<Eigen::Matrix3d> others = turnsAbout(axes[1].line.direction);
    set.rotations.insert(set.rotations.end(), others.begin(), others.end());
    set.num_judged = set.rotations.size();
    return placed(RotationGroupKind::Spherical, 0, set);
  }

  std::optional<PlacedGroup> cylindrical(const FoundAxis& main) const {
    std::vector<double> offsets;
    for (int k = -25; k <= 25; ++k) offsets.push_back(0.02 * k);
    const AxisLineCandidate across = bestAcross(fit_, main.line, M_PI, 1, offsets);
    RotationSet set = turnsOf({main.line.direction, across.center});
    set.rotations.insert(set.rotations.begin() + 1, rotationAbout(across.direction, M_PI));
    set.num_judged = 2;
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
    for (const RotationGroup& group :
         {RotationGroup{RotationGroupKind::Icosahedral, 5}, RotationGroup{RotationGroupKind::Octahedral, 4},
          RotationGroup{RotationGroupKind::Tetrahedral, 3}}) {
      const std::vector<RotationAxis> own = axesOf(group.elements());
      for (std::size_t i = 0; i < axes.size(); ++i)
        for (std::size_t j = i + 1; j < axes.size(); ++j)
          for (const RotationAxis& a : own)
            for (const RotationAxis& b : own)
              if (auto found = polyhedralGroup(group, axes[i], axes[j], a, b)) return found;
    }
    return std::nullopt;
  }

  /// Two axes that are not parallel place a group, up to itself.
  std::optional<PlacedGroup> polyhedralGroup(const RotationGroup& group, const FoundAxis& first,
                                             const FoundAxis& second, const RotationAxis& a,
                                             const RotationAxis& b) const {
    if (a.order % first.fold != 0 || b.order % second.fold != 0) return std::nullopt;
    const double cosine = a.direction.dot(b.direction);
    const Eigen::Vector3d direction =
        first.line.direction.dot(second.line.direction) * cosine < 0.0 ? -second.line.direction : second.line.direction;
    const double expected = angleBetween(a.direction, b.direction);
    if (expected < kMeets || std::abs(angleBetween(first.line.direction, direction) - expected) > kMeets)
      return std::nullopt;
    const Eigen::Matrix3d frame =
        frameOf(first.line.direction, direction) * frameOf(a.direction, b.direction).transpose();
    return placed(group.kind, group.fold, turnedTo(frame, first.line.center, group));
  }

  const RotationFit& fit_;
  const ObjectSymmetryOptions& options_;
};

/// Of all directions across \p axis the one closest to a coordinate axis.
Eigen::Vector3d directionAcross(const Eigen::Vector3d& axis) {
  int most_across = 0;
  axis.cwiseAbs().minCoeff(&most_across);
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(most_across);
  return (unit - axis.dot(unit) * axis).normalized();
}

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
    result.continuous.push_back({signedDirection(group.axis), result.center});
    if (group.kind == RotationGroupKind::Cylindrical)
      result.discrete.push_back(motion(rotationAbout(directionAcross(group.axis), M_PI)));
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
  check(points.allFinite(), "points", "not finite", "finite");
  Stopwatch watch;
  const Points distinct = DistinctPoints(points).points;
  check(distinct.cols() >= kLeastPoints, "number of different points", distinct.cols(), ">= 20");
  const PrincipalAxes principal = principalAxes(distinct);
  check(principal.variances[1] > kLeastWidth * principal.variances[0], "extent across the longest axis", 0, "> 0");
  const Points used = pointsAt(distinct, drawSamples(distinct.cols(), options.max_points, options.seed));
  const BoundingBall ball = boundingBall(used);
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
