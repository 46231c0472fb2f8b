#include "core/rotation/rotation_axes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/directions.h"
#include "core/geometry/geometry_rules.h"

namespace pcl_symmetry {

namespace {

Eigen::Vector3d directionAt(int k, int count) {
  return spiralDirection(k, count, kGoldenAngle * k);
}

/// The overlap of a rotation; 0 if a part of the points shows that it is too small.
double overlapOrLess(const RotationFit& fit, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& center) {
  return fit.overlap(rotation, center, kRotation.num_first_points) < kRotation.first_overlap
             ? 0.0
             : fit.overlap(rotation, center);
}

/// The directions of the greatest values that are not close to each other.
std::vector<int> peaks(const std::vector<double>& values) {
  const int size = static_cast<int>(values.size());
  std::vector<int> kept;
  for (const int k : descendingOrder(values)) {
    if (kept.size() >= kRotation.max_directions || values[k] < kRotation.min_line_overlap) break;
    if (!isNearAny(kept, directionAt(k, size), std::cos(kRotation.min_angle),
                   [&](int other) { return directionAt(other, size); }))
      kept.push_back(k);
  }
  return kept;
}

/// Overlaps of the rotations by 2 pi / n about a line, at index n; 0 if the rotation by half of that angle overlaps
/// clearly better. Small rotations overlap well with any shape, and the better the smaller they are.
std::vector<double> foldOverlaps(const RotationFit& fit, const Line3d& line, int max_fold) {
  std::vector<double> overlaps(static_cast<std::size_t>(max_fold) + 1, 0.0);
  for (int n = 2; n <= max_fold; ++n) {
    const double own = fit.overlap(rotationAbout(line.direction(), 2.0 * kPi / n), line.origin());
    const double half = fit.overlap(rotationAbout(line.direction(), kPi / n), line.origin());
    overlaps[n] = own >= half - kRotation.half_allowance ? own : 0.0;
  }
  return overlaps;
}

/// Lines through one center about which a rotation of prime order overlaps most. A rotation of any order has a power of
/// prime order; an axis with only greater primes is the only one of its shape, hence a principal axis of the points.
std::vector<Line3d> linesThrough(const Eigen::Vector3d& center, const RotationFit& fit, int num_directions,
                                 int max_fold, int num_threads) {
  std::vector<Line3d> lines;
  for (const int prime : {2, 3, 5, 7}) {
    if (prime > max_fold) break;
    std::vector<double> overlaps(num_directions);
    parallelBlocks(overlaps.size(), num_threads, [&](std::size_t k) {
      overlaps[k] = overlapOrLess(
          fit, rotationAbout(directionAt(static_cast<int>(k), num_directions), 2.0 * kPi / prime), center);
    });
    for (const int k : peaks(overlaps)) lines.emplace_back(center, directionAt(k, num_directions));
  }
  return lines;
}

/// Centers that axes may pass through: the center of mass, and if that is elsewhere because points are unevenly dense,
/// the center of the bounding ball, which is 0.
std::vector<Eigen::Vector3d> axisCenters(const RotationFit& fit) {
  const Eigen::Vector3d mass = centerOfMass(fit.points());
  return mass.norm() > kRotation.same_line ? std::vector<Eigen::Vector3d>{mass, Eigen::Vector3d::Zero()}
                                           : std::vector{mass};
}

constexpr MergeTolerance kSameLine{kRotation.same_line, kRotation.same_line};

/// Folds in [2, \p max_fold] whose rotations by 2 pi / n overlap best with the surface, among those that overlap as
/// well as half the rotation: one of at most small_fold and, if it differs, one of all.
/// \return one or two, ascending.
std::vector<int> likelyFolds(const RotationFit& fit, const Line3d& line, int max_fold) {
  const std::vector<double> overlaps = foldOverlaps(fit, line, max_fold);
  const auto minNearBest = [&](int last) {
    const double best = *std::max_element(overlaps.begin(), overlaps.begin() + last + 1);
    int n = 2;
    while (overlaps[n] < best - kRotation.near_best) ++n;
    return n;
  };
  const int small = minNearBest(std::min(kRotation.small_fold, max_fold)), any = minNearBest(max_fold);
  return any == small ? std::vector{small} : std::vector{small, any};
}

// Multiples of 1/97 of a full rotation show whether a line is an axis of revolution: 97 is prime, so that they lie at
// all phases of every fold up to 60.
constexpr int kNumPhases = 97;

/// The shares that rotations about a line map off the surface, judged by some of the points. Each is computed only
/// once.
class RotationProfile {
public:
  RotationProfile(const RotationFit& fit, const Line3d& line) : fit_(fit), line_(line) {}

  /// \return shares of the rotation by \p part / \p whole of a full turn.
  const OffShares& shares(int part, int whole) {
    const int divisor = std::gcd(part, whole);
    part = std::min(part / divisor, (whole - part) / divisor);  // a rotation and its inverse fail alike
    whole /= divisor;
    const auto [entry, is_new] = shares_.insert({{part, whole}, {}});
    if (is_new) entry->second = fit_.offShares(rotation(part, whole), line_.origin(), kRotation.num_some_points);
    return entry->second;
  }

  double excess(int part, int whole) { return fit_.limits().excess(shares(part, whole)); }

  Eigen::Matrix3d rotation(int part, int whole) const {
    return rotationAbout(line_.direction(), 2.0 * kPi * part / whole);
  }

private:
  const RotationFit& fit_;
  const Line3d& line_;
  std::map<std::pair<int, int>, OffShares> shares_;
};

/// The axis of a rotation, near the point where the search for it began.
Line3d lineOf(const RotationSet& rotation, const Line3d& start) {
  const Eigen::Vector3d direction = Eigen::AngleAxisd(rotation.rotations[0]).axis();
  return {rotation.center + direction.dot(start.origin() - rotation.center) * direction, direction};
}

/// The likeliest rotation about a line, moved to where it fits best; nothing if it does not fit or ends at a line that
/// was tried.
std::optional<RotationSet> fittedRotation(const RotationFit& fit, const Line3d& start, int max_fold,
                                          const std::vector<Line3d>& tried) {
  RotationSet best;
  double overlap = 0.0;
  for (const int fold : likelyFolds(fit, start, max_fold)) {
    RotationSet other{{rotationAbout(start.direction(), 2.0 * kPi / fold)}, start.origin(), 1};
    if (fit.overlap(other) < kRotation.min_overlap) continue;
    other = fit.fitRoughly(other);
    const double fitted_overlap = fit.overlap(other);
    if (fitted_overlap <= overlap + kRotation.clearly_better) continue;
    overlap = fitted_overlap;
    best = std::move(other);
  }
  if (overlap < kRotation.rough_overlap || kSameLine.anySame(tried, lineOf(best, start))) return std::nullopt;
  best = fit.fitClosely(best);
  return fit.overlap(best) < kRotation.fair_overlap ? std::nullopt : std::optional(best);
}

/// The surface, judged at a tolerance that is not trivial for rotations about a line: about the axis of a slender part,
/// every point moves by less than a share of its length.
RotationFit fitAbout(const RotationFit& fit, const Line3d& line) {
  double sq_radius = 0.0;
  for (Eigen::Index i = 0; i < fit.points().cols(); ++i)
    sq_radius =
        std::max(sq_radius, (fit.points().col(i).cast<double>() - line.origin()).cross(line.direction()).squaredNorm());
  RotationLimits limits = fit.limits();
  limits.tolerance = std::min(limits.tolerance, kRotation.max_tolerance_of_radius * std::sqrt(sq_radius));
  return fit.withLimits(limits);
}

/// A failing rotation about a line: the first one that fails clearly, or else the worst one.
std::pair<int, double> failingRotation(RotationProfile& profile, double max_excess) {
  std::pair<int, double> worst{1, 0.0};
  for (int k = 1; 2 * k < kNumPhases && worst.second <= max_excess; ++k) {
    const int part = 1 + (k * 19) % (kNumPhases / 2);  // the first parts are spread over half a rotation
    if (const double excess = profile.excess(part, kNumPhases); excess > worst.second) worst = {part, excess};
  }
  return worst;
}

/// The worst excess of the rotations by multiples of 1 / \p fold, or one above \p max_excess.
double excessOfFold(RotationProfile& profile, int fold, double max_excess) {
  double worst = 0.0;
  for (int k = 1; 2 * k <= fold && worst <= max_excess; ++k) worst = std::max(worst, profile.excess(k, fold));
  return worst;
}

/// The least excess of the rotations halfway between those of a fold.
double excessBetween(RotationProfile& profile, int fold) {
  double least = profile.excess(1, 2 * fold);
  for (int k = 3; k <= fold; k += 2) least = std::min(least, profile.excess(k, 2 * fold));
  return least;
}

/// The n for which the rotations by 2 pi / n and its multiples are symmetries, and fit clearly better than those
/// halfway between. A multiple of a true fold fails that: half its rotations are no symmetries, or fit as well as any
/// other.
/// \return the greatest first.
std::vector<int> foldsOf(const RotationFit& fit, RotationProfile& profile, const Line3d& line, int max_fold) {
  const double max_excess = greatestExcess(fit.limits());
  std::vector<int> folds;
  for (int n = max_fold; n >= 2; --n) {
    if (fit.overlap(profile.rotation(1, n), line.origin()) < kRotation.rough_overlap) continue;
    const double excess = excessOfFold(profile, n, max_excess);
    if (excess > max_excess) continue;
    // Reject a fold unless the rotations halfway between its own fail clearly more.
    const double others = excessBetween(profile, n);
    if (others >= kRotation.clear_factor * excess && others >= excess + kRotation.clear_excess) folds.push_back(n);
  }
  return folds;
}

}  // namespace

std::vector<Line3d> principalLines(const RotationFit& fit) {
  const PrincipalAxes principal = principalAxes(fit.points());
  std::vector<Line3d> lines;
  const std::vector<Eigen::Vector3d> centers = axisCenters(fit);
  if (centers.size() > 1) lines.emplace_back(principal.center, principal.center.normalized());
  for (const Eigen::Vector3d& center : centers)
    for (int k = 0; k < 3; ++k) lines.emplace_back(center, principal.axes.col(k));
  return lines;
}

std::vector<Line3d> axisLineCandidates(const RotationFit& fit, int num_directions, int max_fold, int num_threads) {
  std::vector<Line3d> lines;
  for (const Eigen::Vector3d& center : axisCenters(fit))
    append(lines, linesThrough(center, fit, num_directions, max_fold, num_threads));
  return lines;
}

Line3d bestAcross(const RotationFit& fit, const Line3d& line, double width, int num_angles,
                  const std::vector<double>& offsets) {
  Line3d best(line.origin(), line.direction().unitOrthogonal());
  double best_overlap = -1.0;
  for (const double offset : offsets) {
    const Eigen::Vector3d center = line.origin() + offset * line.direction();
    for (int k = 0; k < num_angles; ++k) {
      const Eigen::Vector3d direction = directionAcross<double>(line.direction(), width * k / num_angles);
      const double overlap = fit.overlap(rotationAbout(direction, kPi), center);
      if (overlap <= best_overlap) continue;
      best_overlap = overlap;
      best = Line3d(center, direction);
    }
  }
  return best;
}

std::optional<PlacedGroup> AxisFinder::foldAbout(const RotationFit& fit, const Line3d& line,
                                                 const std::vector<int>& folds) const {
  const Eigen::Matrix3d frame = frameAlong(line.direction(), line.direction().unitOrthogonal());
  for (std::size_t i = 0; i < folds.size() && i < kRotation.max_folds; ++i) {
    const RotationSet rotations = elementsOf({RotationGroupKind::Cyclic, folds[i]}, frame, line.origin());
    if (auto axis = placedGroup(fit, options_, RotationGroupKind::Cyclic, folds[i], rotations)) return axis;
  }
  return std::nullopt;
}

/// The line with all rotations about it that are symmetries. Three or more equal pieces around a line are a pattern:
/// their fold has precedence over rotations by all angles, even if the pieces together are small enough for a feature.
std::optional<PlacedGroup> AxisFinder::axisAbout(const Line3d& line) {
  const RotationFit fit = fitAbout(fit_, line);
  RotationProfile profile(fit, line);
  const double max_excess = greatestExcess(fit.limits());
  const auto failing = failingRotation(profile, max_excess);
  const int worst = failing.first;
  const double excess = failing.second;
  const auto revolution = [&]() -> std::optional<PlacedGroup> {
    if (excess > kRotation.max_worst * max_excess) return std::nullopt;
    return placedGroup(fit, options_, RotationGroupKind::Revolution, 0, rotationsAbout(line));
  };
  std::vector<int> folds;
  if (excess >= kRotation.pattern_excess) folds = foldsOf(fit, profile, line, options_.max_fold);
  const bool is_pattern = !folds.empty() && (folds.front() >= kRotation.min_pattern || excess > 1.0);
  std::optional<PlacedGroup> axis = is_pattern ? foldAbout(fit, line, folds) : revolution();
  if (!axis) axis = is_pattern ? revolution() : foldAbout(fit, line, folds);
  if (!axis || axis->fold > 0)
    rejected_.push_back({line, 0, 2.0 * kPi * worst / kNumPhases, profile.shares(worst, kNumPhases)});
  return axis;
}

void AxisFinder::judge(const std::vector<Line3d>& lines) {
  for (const Line3d& start : lines) {
    if (isRound() || axes_.size() >= kRotation.max_axes) break;
    if (kSameLine.anySame(tried_, start)) continue;
    const std::optional<RotationSet> rotation = fittedRotation(fit_, start, options_.max_fold, tried_);
    const bool is_new = rotation && !kSameLine.anySame(tried_, lineOf(*rotation, start));
    tried_.push_back(start);
    if (!is_new) continue;
    const Line3d line = lineOf(*rotation, start);
    tried_.push_back(line);
    const OffShares shares = fit_.offShares(rotation->rotations[0], rotation->center, kRotation.num_some_points);
    if (fit_.limits().excess(shares) > greatestExcess(fit_.limits())) {
      const double angle = Eigen::AngleAxisd(rotation->rotations[0]).angle();
      rejected_.push_back({line, static_cast<int>(std::lround(2.0 * kPi / angle)), angle, shares});
      continue;
    }
    std::optional<PlacedGroup> axis = axisAbout(line);
    if (!axis) continue;
    if (axis->fold == 0) axes_.clear();
    axes_.push_back(std::move(*axis));
  }
  sortDescending(axes_, &PlacedGroup::fold);
}

}  // namespace pcl_symmetry
