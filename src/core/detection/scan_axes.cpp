#include "core/detection/scan_axes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/detection/axis_starts.h"
#include "core/detection/turn_confidence.h"
#include "core/detection/turn_limits.h"
#include "core/detection/turn_signs.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/answerable_points.h"
#include "core/geometry/distinct_points.h"
#include "core/geometry/search_views.h"

namespace pcl_symmetry {

namespace {

constexpr int kMostTurnFold = 12;  // chosen: bodies of more folds are nearly round to a scan
// Turns that stand for all, besides small ones. chosen: half overlooks handles, twice takes twice the time.
constexpr int kRoundTurns = 10;
// Radians: turns that the fit of a round body uses, both ways. chosen: smaller ones fix the axis badly, larger ones
// leave what was seen.
constexpr double kSmallTurn = 0.26, kLargerTurn = 0.7;
// kMostOff and kMostFar for screening, and tolerances of its distances. chosen: twice, for the error of the EDT.
constexpr double kRoughTurns = 3.0, kRoughSlack = 2.0;
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
  SymmetryTurn turn;  ///< without a place
  double margin;      ///< marginOf()
};

class AxisJudge {
public:
  explicit AxisJudge(const TurnEvidence& evidence) : evidence_(evidence) {}

  Line3d fitted(const AxisStart& start) const { return evidence_.refined(start.line, fitAngles(start.fold)); }

  /// The best that can be said of a line.
  std::optional<JudgedTurns> judged(const Line3d& line) const {
    constexpr TurnLimits kRough{kRoughTurns * kMostOff, kRoughTurns * kMostFar};  // derived: from both
    const auto roughly = [&](double angle) {
      return evidence_.roughly(Eigen::Affine3d(turnAbout(line, angle)), kRoughSlack, kRough.off, kRough.far);
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
    line = evidence_.closelyRefined(line, fitAngles(fold));
    const auto shares = [&](double angle) { return evidence_.exactly(Eigen::Affine3d(turnAbout(line, angle))); };
    const TurnsTogether own = fold == 0 ? roundTurns(shares) : turnsOfFold(shares, fold, 0.0);
    SymmetryTurn turn{Eigen::Vector3d::Zero(), line.direction(), fold, 0.0, own.on, own.off, own.far, 0.0};
    if (fold > 0) turn.halfway = turnsOfFold(shares, fold, 0.5).off;
    return {line, turn, marginOf(turn)};
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
                                   const std::vector<SymmetryAxis>& axes, const DetectionOptions& options,
                                   std::vector<JudgedTurn>* evidence_of_all) {
  const NormalizedCloud& cloud = evidence.cloud();
  std::vector<AxisStart> starts = startsFromNormals(cloud, options.seed, options.num_threads);
  const auto append = [&](const std::vector<AxisStart>& more) {
    starts.insert(starts.end(), more.begin(), more.end());
  };
  for (const SymmetryAxis& axis : axes) starts.push_back({cloud.lineOf(axis), 0});
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
  for (JudgedTurns& turns : found) {
    turns.turn.point = cloud.toInput(turns.line.projection(Eigen::Vector3d::Zero()));
    result.push_back(turns.turn);
  }
  const double least = evidence_of_all ? 0.0 : options.min_possible;
  const std::vector<TurnSigns> signs = turnSigns(evidence, result, least, options.num_threads);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].confidence = turnConfidence(result[i], signs[i]);
    if (evidence_of_all) evidence_of_all->push_back({result[i], signs[i]});
  }
  result.erase(std::remove_if(result.begin(), result.end(),
                              [&](const SymmetryTurn& turn) { return turn.confidence < options.min_possible; }),
               result.end());
  std::stable_sort(result.begin(), result.end(),
                   [](const SymmetryTurn& a, const SymmetryTurn& b) { return a.confidence > b.confidence; });
  return result;
}

std::vector<SymmetryTurn> turnsOfScan(const PointsRef& points, const GaussianEdt& edt, const Visibility& visibility,
                                      const std::vector<SymmetryAxis>& axes, const DetectionOptions& options,
                                      const MakeSearch& make_search) {
  if (!whyUnanswerable(points).empty()) return {};
  const Points distinct = DistinctPoints(points).points;
  const Points used = pointsAt(distinct, drawSamples(distinct.cols(), kMostScanTurnPoints, options.seed));
  const ClosestPointSearch::Ptr search = make_search ? inFrame(make_search(used), edt.center(), edt.radius()) : nullptr;
  const NormalizedCloud cloud(used, edt, search, &visibility, options.num_threads);
  return scanAxes(TurnEvidence(cloud, options.tolerance * cloud.extent, options.seed), {}, axes, options);
}

std::vector<SymmetryAxis> withRoundTurns(const TurnEvidence& evidence, std::vector<SymmetryAxis> axes,
                                         const std::vector<SymmetryTurn>& turns, const DetectionOptions& options) {
  const NormalizedCloud& cloud = evidence.cloud();
  axes.erase(std::remove_if(axes.begin(), axes.end(),
                            [&](const SymmetryAxis& axis) {
                              const TurnsTogether all = roundTurns([&](double angle) {
                                return evidence.exactly(Eigen::Affine3d(turnAbout(cloud.lineOf(axis), angle)));
                              });
                              return all.far > kMostRoundFar;
                            }),
             axes.end());
  for (const SymmetryTurn& turn : turns) {
    // However probable: a handle that was seen contradicts.
    const bool is_contradicted = turn.off > kMostRoundOff || turn.far > kMostRoundFar;
    if (turn.fold != 0 || is_contradicted || turn.confidence < options.min_confidence) continue;
    const auto known = std::find_if(axes.begin(), axes.end(), [&](const SymmetryAxis& axis) {
      return isSameLine(cloud.lineOf(axis), cloud.lineOf(turn));
    });
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
