#include "core/detection/scan_axes/scan_axes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/detection/scan_axes/axis_starts.h"
#include "core/detection/scan_axes/turn_confidence.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/neighbours/answerable_points.h"
#include "core/neighbours/distinct_points.h"

namespace pcl_symmetry {

namespace {

constexpr int kMostTurnFold = 12;  // chosen: bodies of more folds are nearly round to a scan
// Turns that stand for all, besides small ones. chosen: half overlooks handles, twice takes twice the time.
constexpr int kRoundTurns = 10;
// Radians: turns that the fit of a round body uses, both ways. chosen: smaller ones fix the axis badly, larger ones
// leave what was seen.
constexpr double kSmallTurn = 0.26, kLargerTurn = 0.7;
// Shares of the points seen that the worst turn may throw into empty space, and farther than ten tolerances there: of
// folds and of round bodies. measured: pcl_symmetry_evaluate shapes turns, tuning half; 0.000 and 0.000 of round
// bodies, 0.024 and 0.009 of a mug whose handle is 2.5 % of what is seen. chosen: folds are given as much as features
// of whole objects, halved; twice takes shallow features for symmetric.
constexpr double kMostOff = 0.05, kMostFar = 0.0125, kMostRoundOff = 0.015, kMostRoundFar = 0.004;
// The same for screening, and tolerances of its distances. chosen: twice, for the error of the EDT.
constexpr double kRoughFactor = 3.0, kRoughSlack = 2.0;
// Shares that land on the surface by small turns of a round body, by the best turn of a fold, and of fold 2 (of which
// most is hidden). chosen: half lists turns that nothing seen confirms, twice loses slender bodies.
constexpr double kRoundOn = 0.6, kFoldOn = 0.3, kHalfTurnOn = 0.75;
// By how much more the turns halfway throw into empty space. chosen: half lets chance choose folds of round bodies,
// twice loses shallow folds.
constexpr double kHalfwayMore = 0.06;
constexpr std::size_t kMostPlanesOfAxes = 8;                    // chosen: 28 lines; more are of false planes
constexpr double kPlaneShare = 0.85;                            // chosen: planes of less are none of the whole
constexpr double kSameTurnAngle = 0.12, kSameTurnOffset = 0.1;  // radians, radii; chosen: no body has two axes nearer
// Radians, radii: fitted lines that are judged once. chosen: half judges lines twice, twice may judge the worse one.
constexpr double kFittedAngle = 0.02, kFittedOffset = 0.02;
constexpr std::size_t kMostTurns = 5;        // chosen: a polyhedron seen from a corner shows as many
constexpr int kMostScanTurnPoints = 10'000;  // chosen: as DetectionOptions::num_refine_samples
constexpr int kScoredPlanes = 4;  // chosen: D of a round body differs little between planes; each takes a millisecond

/// The worst of several turns, and the greatest share on the surface.
struct TurnsTogether {
  double on = 0.0, off = 0.0, far = 0.0;

  void add(const TurnShares& shares) {
    on = std::max(on, shares.on);
    off = std::max(off, shares.off);
    far = std::max(far, shares.far);
  }
};

/// Shares that turns may throw into empty space, and far into it: beyond, a line is refused.
struct TurnLimits {
  double off = 1.0, far = 1.0;

  bool allow(const TurnsTogether& turns) const { return turns.off <= off && turns.far <= far; }
};

/// \param limits where more is off the rest is left out.
template <typename Shares>
TurnsTogether roundTurns(const Shares& shares, const TurnLimits& limits = {}) {
  TurnsTogether all;
  for (int k = 1; k <= kRoundTurns && limits.allow(all); ++k) all.add(shares(2.0 * kPi * goldenFraction(k)));
  if (limits.allow(all)) all.on = 0.5 * (shares(kSmallTurn).on + shares(-kSmallTurn).on);
  return all;
}

template <typename Shares>
TurnsTogether turnsOfFold(const Shares& shares, int fold, double first, const TurnLimits& limits = {}) {
  TurnsTogether all;
  for (int k = 0; k < fold && limits.allow(all); ++k)
    if (k + first > 0.0) all.add(shares(2.0 * kPi * (k + first) / fold));
  return all;
}

/// What a line is, as far as one scan can tell.
struct JudgedTurns {
  Line3d line;
  int fold;
  TurnsTogether own, halfway;
  double margin;
};

/// The least margin to a limit, >= 0 where all are kept: by it the orders of a line and the lines are compared. What is
/// reported is turnConfidence(), which is fitted to lines that were chosen so.
double marginOf(int fold, const TurnsTogether& own, const TurnsTogether& halfway) {
  const double least_on = fold == 0 ? kRoundOn : fold == 2 ? kHalfTurnOn : kFoldOn;
  const double most_off = fold == 0 ? kMostRoundOff : kMostOff, most_far = fold == 0 ? kMostRoundFar : kMostFar;
  double margin = std::min({1.0 - own.off / most_off, 1.0 - own.far / most_far, own.on / least_on - 1.0});
  if (fold > 0) margin = std::min(margin, (halfway.off - own.off) / kHalfwayMore - 1.0);
  return margin;
}

class AxisJudge {
public:
  explicit AxisJudge(const TurnEvidence& evidence) : evidence_(evidence) {}

  Line3d fitted(const AxisStart& start) const { return evidence_.refined(start.line, fitAngles(start.fold)); }

  /// The best that can be said of a line.
  std::optional<JudgedTurns> judged(const Line3d& line) const {
    constexpr TurnLimits kRough{kRoughFactor * kMostOff, kRoughFactor * kMostFar};  // derived: from both
    const auto roughly = [&](double angle) {
      return evidence_.roughly(line, angle, kRoughSlack, kRough.off, kRough.far);
    };
    std::optional<JudgedTurns> best;
    const auto take = [&](JudgedTurns&& turns) {
      if (!best || turns.margin > best->margin) best = turns;
    };
    if (kRough.allow(roundTurns(roughly, kRough))) take(exactly(line, 0));
    for (int fold = kMostTurnFold; fold >= 2; --fold) {
      if (best && best->margin > 0.0) break;
      if (kRough.allow(turnsOfFold(roughly, fold, 0.0, kRough))) take(exactly(line, fold));
    }
    return best;
  }

  JudgedTurns exactly(Line3d line, int fold) const {
    line = evidence_.refined(line, fitAngles(fold));
    const auto shares = [&](double angle) { return evidence_.exactly(line, angle); };
    JudgedTurns turns{line, fold, {}, {}, 0.0};
    turns.own = fold == 0 ? roundTurns(shares) : turnsOfFold(shares, fold, 0.0);
    if (fold > 0) turns.halfway = turnsOfFold(shares, fold, 0.5);
    turns.margin = marginOf(fold, turns.own, turns.halfway);
    return turns;
  }

private:
  static std::vector<double> fitAngles(int fold) {
    if (fold == 0) return {kSmallTurn, -kSmallTurn, kLargerTurn, -kLargerTurn};
    const double step = 2.0 * kPi / fold;
    return fold == 2 ? std::vector<double>{step} : std::vector<double>{step, -step};
  }

  const TurnEvidence& evidence_;
};

/// Planes that may be symmetries, normalised frame.
std::vector<ReflectionPlane> planesOfAxes(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud) {
  std::vector<ReflectionPlane> found;
  for (const SymmetryPlane& plane : planes)
    if (plane.kind != PlaneKind::Local && plane.share >= kPlaneShare && found.size() < kMostPlanesOfAxes)
      found.push_back(cloud.toNormalized(plane));
  return found;
}

bool isNear(const Line3d& a, const Line3d& b, double angle, double offset) {
  return std::abs(a.direction().dot(b.direction())) > std::cos(angle) &&
         a.distance(b.projection(Eigen::Vector3d::Zero())) < offset;
}

bool isNearly(const Line3d& a, const Line3d& b) {
  return isNear(a, b, kFittedAngle, kFittedOffset);
}

bool isSameLine(const Line3d& a, const Line3d& b) {
  return isNear(a, b, kSameTurnAngle, kSameTurnOffset);
}

}  // namespace

std::vector<SymmetryTurn> scanAxes(const TurnEvidence& evidence, const std::vector<SymmetryPlane>& planes,
                                   const std::vector<SymmetryAxis>& axes, const DetectionOptions& options) {
  const NormalizedCloud& cloud = evidence.cloud();
  std::vector<AxisStart> starts = startsFromNormals(cloud, options.seed);
  const auto append = [&](const std::vector<AxisStart>& more) {
    starts.insert(starts.end(), more.begin(), more.end());
  };
  for (const SymmetryAxis& axis : axes)
    starts.push_back({Line3d((axis.point - cloud.center) / cloud.scale, axis.direction), 0});
  append(startsFromPlanes(planesOfAxes(planes, cloud), kMostTurnFold));
  append(startsFromTransform(cloud, options.seed, options.num_threads));
  const AxisJudge judge(evidence);
  std::vector<Line3d> fitted(starts.size());
  parallelBlocks(starts.size(), options.num_threads, [&](std::size_t i) { fitted[i] = judge.fitted(starts[i]); });
  std::vector<Line3d> lines;
  for (const Line3d& line : fitted)
    if (line.direction().allFinite() && line.origin().allFinite() &&
        std::none_of(lines.begin(), lines.end(), [&](const Line3d& other) { return isNearly(other, line); }))
      lines.push_back(line);
  std::vector<std::optional<JudgedTurns>> judged(lines.size());
  parallelBlocks(lines.size(), options.num_threads, [&](std::size_t i) { judged[i] = judge.judged(lines[i]); });
  std::stable_sort(judged.begin(), judged.end(),
                   [](const auto& a, const auto& b) { return a && (!b || a->margin > b->margin); });
  std::vector<JudgedTurns> found;
  for (const std::optional<JudgedTurns>& turns : judged) {
    if (!turns || found.size() == kMostTurns) break;
    if (std::none_of(found.begin(), found.end(), [&](const JudgedTurns& o) { return isSameLine(o.line, turns->line); }))
      found.push_back(*turns);
  }
  std::vector<SymmetryTurn> result;
  for (const JudgedTurns& turns : found) {
    result.push_back({turns.line.projection(Eigen::Vector3d::Zero()) * cloud.scale + cloud.center,
                      turns.line.direction(), turns.fold, 0.0, turns.own.on, turns.own.off, turns.own.far,
                      turns.halfway.off});
    result.back().confidence = turnConfidence(result.back());
    if (result.back().confidence < options.min_possible) result.pop_back();
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const SymmetryTurn& a, const SymmetryTurn& b) { return a.confidence > b.confidence; });
  return result;
}

std::vector<SymmetryTurn> turnsOfScan(const PointsRef& points, const GaussianEdt& edt, const Visibility& visibility,
                                      const std::vector<SymmetryAxis>& axes, const DetectionOptions& options) {
  if (!whyUnanswerable(points).empty()) return {};
  const Points distinct = DistinctPoints(points).points;
  const Points used = pointsAt(distinct, drawSamples(distinct.cols(), kMostScanTurnPoints, options.seed));
  const NormalizedCloud cloud(used, edt, nullptr, &visibility, options.num_threads);
  return scanAxes(TurnEvidence(cloud, options.tolerance * cloud.extent, options.seed), {}, axes, options);
}

std::vector<SymmetryAxis> withRoundTurns(const TurnEvidence& evidence, std::vector<SymmetryAxis> axes,
                                         const std::vector<SymmetryTurn>& turns, const DetectionOptions& options) {
  const NormalizedCloud& cloud = evidence.cloud();
  const auto lineOf = [&](const auto& axis) {
    return Line3d((axis.point - cloud.center) / cloud.scale, axis.direction);
  };
  axes.erase(std::remove_if(axes.begin(), axes.end(),
                            [&](const SymmetryAxis& axis) {
                              const TurnsTogether all =
                                  roundTurns([&](double angle) { return evidence.exactly(lineOf(axis), angle); });
                              return all.far > kMostRoundFar;
                            }),
             axes.end());
  for (const SymmetryTurn& turn : turns) {
    // However probable: a handle that was seen contradicts.
    const bool is_contradicted = turn.off > kMostRoundOff || turn.far > kMostRoundFar;
    if (turn.fold != 0 || is_contradicted || turn.confidence < options.min_confidence) continue;
    const auto known = std::find_if(axes.begin(), axes.end(),
                                    [&](const SymmetryAxis& axis) { return isSameLine(lineOf(axis), lineOf(turn)); });
    if (known != axes.end()) {
      known->point = turn.point;
      known->direction = turn.direction;
    } else {
      double score = 0.0;
      for (int k = 0; k < kScoredPlanes; ++k) {
        const double angle = kPi * k / kScoredPlanes;
        const Eigen::Vector3d u = turn.direction.unitOrthogonal(), v = turn.direction.cross(u);
        const Eigen::Vector3d normal = std::cos(angle) * u + std::sin(angle) * v;
        score += cloud.score(ReflectionPlane(normal, normal.dot(turn.point))) / kScoredPlanes;
      }
      axes.push_back({turn.point, turn.direction, turn.confidence, score, turn.support});
    }
  }
  return axes;
}

}  // namespace pcl_symmetry
