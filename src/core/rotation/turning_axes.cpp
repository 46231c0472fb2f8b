#include "core/rotation/turning_axes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/constants.h"

namespace pcl_symmetry {

namespace {

// Overlap of the likeliest turn about a line before its fit. chosen: half fits many lines in vain, at twice (1)
// sampling drops true axes.
constexpr double kLeastTurnOverlap = 0.5;
// Overlap that a turn by a smaller angle needs beyond one by a greater. chosen: chance between 256 points.
constexpr double kClearlyBetter = 0.02;
// Axes that are enough to place any finite group. chosen: half may miss the main axis, twice takes twice the time.
constexpr std::size_t kMaxAxes = 12;
// Turns that tell whether a line is an axis of revolution: multiples of 1/97 of a turn. derived: 97 is prime, so that
// they lie at all phases of every fold up to 60.
constexpr int kProfileTurns = 97;
// Their order: those that come first are spread over half a turn. derived: 48 steps of 19 modulo 48 visit all.
constexpr int kProfileStep = 19;
// Folds of a line that are fitted, the greatest first. chosen: one may fail by chance, four are never needed.
constexpr std::size_t kMostFolds = 3;
// Pieces around a line that are a pattern, and the excess of other turns that makes them one. chosen: two plugs of a
// lamp are features, three spokes are not; at half of the excess, scratches are patterns, at twice thin spokes are
// none.
constexpr int kPattern = 3;
constexpr double kLeastPattern = 0.5;
// What the worst turn by any angle may exceed that of others by. chosen: as for the mean over all turns.
constexpr double kWorstTurn = 1.25;

/// What turns about a line map off the surface, judged by some of the points. Each turn is asked once.
class TurnProfile {
public:
  TurnProfile(const RotationFit& fit, const Line3d& line) : fit_(fit), line_(line) {}

  /// \return shares of the turn by \p part / \p whole of a full turn.
  const OffShares& shares(int part, int whole) {
    const int divisor = std::gcd(part, whole);
    part = std::min(part / divisor, (whole - part) / divisor);  // a turn and its inverse fail alike
    whole /= divisor;
    const auto [entry, is_new] = shares_.insert({{part, whole}, {}});
    if (is_new) entry->second = fit_.offShares(turn(part, whole), line_.origin(), kSomeSamples);
    return entry->second;
  }

  double excess(int part, int whole) { return fit_.limits().excess(shares(part, whole)); }

  Eigen::Matrix3d turn(int part, int whole) const { return rotationAbout(line_.direction(), 2.0 * kPi * part / whole); }

private:
  const RotationFit& fit_;
  const Line3d& line_;
  std::map<std::pair<int, int>, OffShares> shares_;
};

/// The line of a turn, near the place where the search for it began.
Line3d lineOf(const RotationSet& turn, const Line3d& start) {
  const Eigen::Vector3d direction = axisOf(turn.rotations[0]);
  return {turn.center + direction.dot(start.origin() - turn.center) * direction, direction};
}

/// The likeliest turn about a line moved to where it fits best; nothing where no turn fits, or where it ends at a line
/// that was tried.
std::optional<RotationSet> fittedTurn(const RotationFit& fit, const Line3d& start, int max_fold,
                                      const std::vector<Line3d>& tried) {
  RotationSet turn;
  double overlap = 0.0;
  for (const int fold : likelyFolds(fit, start, max_fold)) {
    RotationSet other = singleTurn(start, fold);
    if (fit.overlap(other) < kLeastTurnOverlap) continue;
    other = fit.roughlyFitted(other);
    const double its_overlap = fit.overlap(other);
    if (its_overlap <= overlap + kClearlyBetter) continue;
    overlap = its_overlap;
    turn = std::move(other);
  }
  if (overlap < kRoughOverlap || isKnown(tried, lineOf(turn, start))) return std::nullopt;
  turn = fit.closelyFitted(turn);
  return fit.overlap(turn) < kFairOverlap ? std::nullopt : std::optional(turn);
}

/// A turn about a line that fails: the first that does so clearly, else the worst.
std::pair<int, double> failingTurn(TurnProfile& profile, double most) {
  std::pair<int, double> worst{1, 0.0};
  for (int k = 1; 2 * k < kProfileTurns && worst.second <= most; ++k) {
    const int part = 1 + (k * kProfileStep) % (kProfileTurns / 2);
    if (const double excess = profile.excess(part, kProfileTurns); excess > worst.second) worst = {part, excess};
  }
  return worst;
}

/// The worst excess of the turns by multiples of 1 / \p fold, or a greater one than \p most.
double excessOfFold(TurnProfile& profile, int fold, double most) {
  double worst = 0.0;
  for (int k = 1; 2 * k <= fold && worst <= most; ++k) worst = std::max(worst, profile.excess(k, fold));
  return worst;
}

/// The least excess of the turns halfway between the turns of a fold.
double excessBetween(TurnProfile& profile, int fold) {
  double least = profile.excess(1, 2 * fold);
  for (int k = 3; k <= fold; k += 2) least = std::min(least, profile.excess(k, 2 * fold));
  return least;
}

/// The n for which the turns by 2 pi / n and its multiples are symmetries, and are clearly better than those halfway
/// between. A multiple of a true fold fails that: half its turns are no symmetries, or as good as any.
/// \return the greatest first.
std::vector<int> foldsOf(const RotationFit& fit, TurnProfile& profile, const Line3d& line, int max_fold) {
  const double most = greatestExcess(fit.limits(), kSomeSamples);
  std::vector<int> folds;
  for (int n = max_fold; n >= 2; --n) {
    if (fit.overlap(profile.turn(1, n), line.origin()) < kRoughOverlap) continue;
    const double excess = excessOfFold(profile, n, most);
    if (excess <= most && beatsOthers(excess, excessBetween(profile, n))) folds.push_back(n);
  }
  return folds;
}

/// The axis of a group that was placed about a line.
std::optional<TurningAxis> axisFrom(std::optional<PlacedGroup> group, int fold) {
  if (!group) return std::nullopt;
  const Line3d fitted(group->set.center, group->axis);
  return TurningAxis{fitted, fold, std::move(*group)};
}

}  // namespace

std::optional<TurningAxis> AxisFinder::foldAbout(const Line3d& line, const std::vector<int>& folds) const {
  for (std::size_t i = 0; i < folds.size() && i < kMostFolds; ++i) {
    const RotationSet turns = cyclicSet(line, folds[i]);
    auto axis = axisFrom(placedGroup(fit_, options_, RotationGroupKind::Cyclic, folds[i], turns), folds[i]);
    if (axis) return axis;
  }
  return std::nullopt;
}

/// The line with all turns about it that are symmetries. Three or more equal pieces around a line are a pattern: their
/// fold comes before turns by all angles, though the pieces together be small enough for a feature.
std::optional<TurningAxis> AxisFinder::axisAbout(const Line3d& line) {
  TurnProfile profile(fit_, line);
  const double most = greatestExcess(fit_.limits(), kSomeSamples);
  const auto failing = failingTurn(profile, most);
  const int worst = failing.first;
  const double excess = failing.second;
  const auto revolution = [&]() -> std::optional<TurningAxis> {
    if (excess > kWorstTurn * most) return std::nullopt;
    return axisFrom(placedGroup(fit_, options_, RotationGroupKind::Revolution, 0, turnsAbout(line)), 0);
  };
  std::vector<int> folds;
  if (excess >= kLeastPattern) folds = foldsOf(fit_, profile, line, options_.max_fold);
  const bool is_pattern = !folds.empty() && (folds.front() >= kPattern || excess > 1.0);
  std::optional<TurningAxis> axis = is_pattern ? foldAbout(line, folds) : revolution();
  if (!axis) axis = is_pattern ? revolution() : foldAbout(line, folds);
  if (!axis || axis->fold > 0)
    rejected_.push_back({line, 0, 2.0 * kPi * worst / kProfileTurns, profile.shares(worst, kProfileTurns)});
  return axis;
}

void AxisFinder::judge(const std::vector<Line3d>& lines) {
  for (const Line3d& start : lines) {
    if (isRound() || axes_.size() >= kMaxAxes) break;
    if (isKnown(tried_, start)) continue;
    const std::optional<RotationSet> turn = fittedTurn(fit_, start, options_.max_fold, tried_);
    const bool is_new = turn && !isKnown(tried_, lineOf(*turn, start));
    tried_.push_back(start);
    if (!is_new) continue;
    const Line3d line = lineOf(*turn, start);
    tried_.push_back(line);
    const OffShares shares = fit_.offShares(turn->rotations[0], turn->center, kSomeSamples);
    if (fit_.limits().excess(shares) > greatestExcess(fit_.limits(), kSomeSamples)) {
      const double angle = Eigen::AngleAxisd(turn->rotations[0]).angle();
      rejected_.push_back({line, static_cast<int>(std::lround(2.0 * kPi / angle)), angle, shares});
      continue;
    }
    std::optional<TurningAxis> axis = axisAbout(line);
    if (!axis) continue;
    if (axis->fold == 0) axes_.clear();
    axes_.push_back(std::move(*axis));
  }
  std::stable_sort(axes_.begin(), axes_.end(),
                   [](const TurningAxis& a, const TurningAxis& b) { return a.fold > b.fold; });
}

}  // namespace pcl_symmetry
