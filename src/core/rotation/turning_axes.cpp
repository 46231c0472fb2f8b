#include "core/rotation/turning_axes.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace pcl_symmetry {

namespace {

// Overlap of the likeliest turn about a line before its fit. chosen: half fits many lines in vain, at twice (1)
// sampling drops true axes.
constexpr double kLeastTurnOverlap = 0.5;
// Rough support of that turn after a rough fit. chosen: half fits closely in vain, twice is beyond 1.
constexpr double kLeastSupport = 0.6;
// Axes that are enough to place any finite group. chosen: half may miss the main axis, twice takes twice the time.
constexpr std::size_t kMaxAxes = 12;
// Axes of revolution that are enough. derived: turns about two of them generate all rotations.
constexpr std::size_t kMaxRevolutionAxes = 2;
// Support that one turn may have beyond all turns about an axis of revolution. chosen: as for families of planes; half
// finds polygons in round shapes, twice takes slender prisms for round ones.
constexpr double kAllowance = 0.015;
// Confidence that stands for the identity. chosen: below that of any fold that holds, so that it wins only alone.
constexpr double kIdentityConfidence = 0.01;

/// The line moved to where its likeliest turn fits best; nothing where no turn fits.
std::optional<AxisLineCandidate> fittedLine(const RotationFit& fit, const AxisLineCandidate& start, int max_fold) {
  RotationSet turn = singleTurn(start, likeliestFold(fit, start, max_fold));
  if (fit.overlap(turn) < kLeastTurnOverlap) return std::nullopt;
  turn = fit.roughlyFitted(turn);
  if (fit.overlap(turn) < kRoughOverlap || fit.roughSupport(turn) < kLeastSupport) return std::nullopt;
  turn = fit.closelyFitted(turn);
  if (fit.overlap(turn) < kFairOverlap) return std::nullopt;
  const Eigen::Vector3d direction = axisOf(turn.rotations[0]);
  return AxisLineCandidate{direction, turn.center + direction.dot(start.center - turn.center) * direction};
}

/// The greatest n for which the turns by 2 pi / n and its multiples are symmetries. If neither of two folds divides the
/// other, the more confident one is kept: a shape that has both is round.
int foldOf(const RotationFit& fit, const ObjectSymmetryOptions& options, const AxisLineCandidate& line) {
  std::vector<double> confidence(static_cast<std::size_t>(options.max_fold) + 1, 0.0);
  confidence[1] = kIdentityConfidence;
  std::vector<int> folds{1};
  for (const int n : likelyFolds(fit, line, options.max_fold)) {
    bool parts_hold = true;
    for (int part = 1; part < n; ++part) parts_hold &= n % part != 0 || confidence[part] > 0.0;
    if (!parts_hold) continue;
    RotationSet turns = cyclicSet(line, n);
    if (fit.roughSupport(turns) < kFairSupport) continue;
    // One turn is judged first: that is quicker, and most folds that fail, fail there.
    const std::size_t num_judged = std::exchange(turns.num_judged, 1);
    RotationEvidence evidence = fit.evidence(turns);
    turns.num_judged = num_judged;
    if (holds(evidence, options) && num_judged > 1) evidence = fit.evidence(turns);
    if (!holds(evidence, options)) continue;
    confidence[n] = evidence.confidence;
    folds.erase(std::remove_if(folds.begin(), folds.end(), [&](int part) { return n % part == 0; }), folds.end());
    folds.push_back(n);
  }
  return *std::max_element(folds.begin(), folds.end(), [&](int a, int b) { return confidence[a] < confidence[b]; });
}

/// The axis of a group that was placed about a line.
std::optional<TurningAxis> axisFrom(std::optional<PlacedGroup> group, int fold) {
  if (!group) return std::nullopt;
  const AxisLineCandidate fitted{group->axis, group->set.center};
  return TurningAxis{fitted, fold, std::move(*group)};
}

/// The line as an axis of revolution.
std::optional<TurningAxis> revolutionAbout(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                           const AxisLineCandidate& line) {
  return axisFrom(placedGroup(fit, options, RotationGroupKind::Revolution, 0, turnsAbout(line)), 0);
}

/// The line as the axis of the greatest cyclic group about it.
std::optional<TurningAxis> cyclicAbout(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                       const AxisLineCandidate& line) {
  const int fold = foldOf(fit, options, line);
  if (fold == 1) return std::nullopt;
  return axisFrom(placedGroup(fit, options, RotationGroupKind::Cyclic, fold, cyclicSet(line, fold)), fold);
}

/// The line with all turns about it that are symmetries. A slender prism is not round: a cyclic group whose support is
/// clearly greater than that of all turns wins.
std::optional<TurningAxis> axisAbout(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                     const AxisLineCandidate& line, bool revolution_only) {
  std::optional<TurningAxis> axis = revolutionAbout(fit, options, line);
  if (revolution_only || (axis && axis->group.evidence.support >= 1.0 - kAllowance)) return axis;
  std::optional<TurningAxis> cyclic = cyclicAbout(fit, options, line);
  const bool cyclic_wins =
      cyclic && (!axis || cyclic->group.evidence.support > axis->group.evidence.support + kAllowance);
  return cyclic_wins ? cyclic : axis;
}

}  // namespace

std::vector<TurningAxis> turningAxes(const RotationFit& fit, const ObjectSymmetryOptions& options,
                                     const std::vector<AxisLineCandidate>& lines) {
  std::vector<TurningAxis> axes;
  std::vector<AxisLineCandidate> tried;
  for (const AxisLineCandidate& start : lines) {
    const bool continuous = !axes.empty() && axes.front().fold == 0;
    if (axes.size() >= (continuous ? kMaxRevolutionAxes : kMaxAxes)) break;
    if (isKnown(tried, start)) continue;
    const std::optional<AxisLineCandidate> line = fittedLine(fit, start, options.max_fold);
    if (!line || isKnown(tried, *line)) continue;
    tried.push_back(*line);
    std::optional<TurningAxis> axis = axisAbout(fit, options, *line, continuous);
    if (!axis) continue;
    if (axis->fold == 0 && !continuous) axes.clear();
    axes.push_back(std::move(*axis));
  }
  std::stable_sort(axes.begin(), axes.end(),
                   [](const TurningAxis& a, const TurningAxis& b) { return a.fold > b.fold; });
  return axes;
}

}  // namespace pcl_symmetry
