#include "core/rotation/scan_axes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/base/symmetric_solvers.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/directions.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/surface_normals.h"
#include "pcl_symmetry/core/axial_transform.h"
#include "pcl_symmetry/core/rotational_symmetry.h"

namespace pcl_symmetry {

namespace {

/// A line that may be an axis, and the order of its rotations; 0 = by any angle.
struct AxisStart {
  Line3d line;
  int fold;
};

constexpr MergeTolerance kSameCoarsely{kScanAxes.coarsely_same, kScanAxes.coarsely_same},
    kSameFitted{kScanAxes.fitted_same, kScanAxes.fitted_same},
    kSameAxis{kScanAxes.same_axis_angle, kScanAxes.same_axis_offset};

double missAt(const Line3d& line, const Eigen::Vector3d& x, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d velocity = line.direction().cross(x - line.origin());
  return std::abs(velocity.dot(normal)) / std::max(kGeometry.min_lever, velocity.norm());
}

/// Lines that many normals of a scan meet or are parallel to: the best line for all normals, and the best ones for
/// small draws, so that a base or a handle does not decide.
std::vector<AxisStart> startsFromNormals(const NormalizedCloud& cloud, std::uint64_t seed, int num_threads) {
  const std::vector<int> samples = drawSamples(cloud.points.cols(), kScanAxes.normal_samples, seed);
  const Points& normals = cloud.geometry.normals;
  const auto inliersOf = [&](const Line3d& line) {
    std::vector<int> inliers;
    for (const int i : samples)
      if (missAt(line, cloud.points.col(i).cast<double>(), normals.col(i).cast<double>()) < kGeometry.normal_miss)
        inliers.push_back(i);
    return inliers;
  };
  std::vector<std::vector<int>> draws(1, samples);
  RandomStream random(seed);
  for (int draw = 0; draw < kScanAxes.normal_draws; ++draw) {
    std::vector<int> few;
    for (int k = 0; k < kScanAxes.normals_in_draw; ++k) few.push_back(samples[random.below(samples.size())]);
    draws.push_back(std::move(few));
  }
  std::vector<std::pair<double, Line3d>> found(draws.size());
  parallelRanges(draws.size(), 4, num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Line3d line = axisOfNormals(cloud.points, normals, draws[i]);
      const bool is_line = line.direction().allFinite() && line.origin().allFinite();
      found[i] = {is_line ? -static_cast<double>(inliersOf(line).size()) : 1.0, line};
    }
  });
  eraseIf(found, [](const auto& one) { return one.first > 0.0; });
  sortAscending(found, [](const auto& one) { return one.first; });
  std::vector<AxisStart> starts;
  for (const auto& [unused, line] : found) {
    if (starts.size() == kScanAxes.from_normals) break;
    const std::vector<int> inliers = inliersOf(line);
    if (inliers.empty()) break;
    const Line3d fitted = axisOfNormals(cloud.points, normals, inliers);
    if (!kSameMaximum.anySame(starts, fitted, &AxisStart::line) && fitted.origin().norm() < 2.0)
      starts.push_back({fitted, 0});
  }
  return starts;
}

/// Common lines of planes at an angle of k pi / n.
/// \param planes normalized frame.
/// \param max_fold greatest n, >= 2.
std::vector<AxisStart> startsFromPlanes(const std::vector<ReflectionPlane>& planes, int max_fold) {
  std::vector<AxisStart> starts;
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double angle = planes[i].angleTo(planes[j]);
      if (angle < kScanAxes.min_plane_angle) continue;
      const Eigen::Vector3d& a = planes[i].normal();
      const Eigen::Vector3d& b = planes[j].normal();
      const double cosine = a.dot(b), sq_sine = 1.0 - cosine * cosine;
      const double s = (planes[i].offset() - cosine * planes[j].offset()) / sq_sine,
                   t = (planes[j].offset() - cosine * planes[i].offset()) / sq_sine;
      const Line3d line(s * a + t * b, a.cross(b).normalized());
      // The least fold that has planes at this angle: two planes at k pi / n generate a rotation by 2 k pi / n.
      for (int n = 2; n <= max_fold; ++n) {
        const double step = kPi / n, off = std::abs(angle - step * std::round(angle / step));
        if (off > kScanAxes.angle_of_fold * std::min(1.0, 6.0 / n)) continue;
        starts.push_back({line, n});
        break;
      }
    }
  return starts;
}

/// Maxima of an axial transform with few bins and the free space of the scan.
std::vector<AxisStart> startsFromTransform(const NormalizedCloud& cloud, std::uint64_t seed, int num_threads) {
  const GaussianEdt edt(cloud.points, {kScanAxes.coarse_cells, 0.0, num_threads});
  const AxialTransformOptions options{{2, 3, 4, 5, 6}, kScanAxes.coarse_samples, seed, num_threads};
  const AxisGrid grid(kScanAxes.coarse_theta, kScanAxes.coarse_phi, kScanAxes.coarse_offset, edt.center(),
                      kScanAxes.coarse_reach * edt.radius());
  const AxisMap map = axialTransform(edt, grid, options, &*cloud.visibility);
  std::vector<AxisStart> starts;
  for (const int bin : descendingOrder(map.greatest)) {
    if (starts.size() == kScanAxes.coarse_maxima || !(map.greatest[bin] > 0.0f)) break;
    const Line3d line = grid.axis(grid.bin(bin));
    if (kSameCoarsely.anySame(starts, line, &AxisStart::line)) continue;
    int fold = 2;
    for (std::size_t i = 0; i < map.folds.size(); ++i)
      if (map.values[i][bin] >= map.greatest[bin] - kScanAxes.coarse_equal) fold = std::max(fold, map.folds[i]);
    starts.push_back({line, fold});
  }
  return starts;
}

/// The worse shares off the surface of two rotations, and the greater share on it.
RotationShares worstOf(const RotationShares& a, const RotationShares& b) {
  return {std::max(a.on, b.on), std::max(a.off, b.off), std::max(a.far, b.far)};
}

/// Greatest shares that rotations may map into free space, and far into it; beyond them, a line is rejected.
struct OffLimits {
  double off = 1.0, far = 1.0;

  bool allow(const RotationShares& all) const { return all.off <= off && all.far <= far; }
};

/// \param limits the remaining rotations are skipped once these are exceeded.
template <typename Shares>
RotationShares worstRoundShares(const Shares& shares, const OffLimits& limits = {}) {
  RotationShares all;
  for (int k = 1; k <= kScanAxes.round_rotations && limits.allow(all); ++k)
    all = worstOf(all, shares(2.0 * kPi * goldenFraction(k)));
  if (limits.allow(all)) all.on = 0.5 * (shares(kScanAxes.small_angle).on + shares(-kScanAxes.small_angle).on);
  return all;
}

template <typename Shares>
RotationShares worstSharesOfFold(const Shares& shares, int fold, double first, const OffLimits& limits = {}) {
  RotationShares all;
  for (int k = 0; k < fold && limits.allow(all); ++k)
    if (k + first > 0.0) all = worstOf(all, shares(2.0 * kPi * (k + first) / fold));
  return all;
}

constexpr OffLimits kScreeningLimits{kScanAxes.rough_factor * kScanAxes.max_off,
                                     kScanAxes.rough_factor* kScanAxes.max_far};

/// Screens rotations about a line by an angle.
struct ScreenedShares {
  const RotationEvidence& evidence;
  const Line3d& line;

  RotationShares operator()(double angle) const {
    return evidence.screen(motionAbout(line, angle), kScreeningLimits.off, kScreeningLimits.far);
  }
};

/// What one scan shows of a line.
struct JudgedLine {
  Line3d line;
  SymmetryRotation rotation;  ///< the position is not set
  double margin;              ///< see marginOf()
};

class AxisJudge {
public:
  /// \param max_fold greatest fold of the rotations that are tried, in addition to rotations by any angle.
  AxisJudge(const RotationEvidence& evidence, int max_fold) : evidence_(evidence), max_fold_(max_fold) {}

  /// The lines of some starts, where rotations fit best.
  std::vector<Line3d> fitLines(const std::vector<AxisStart>& starts, int num_threads) const {
    std::vector<Line3d> lines(starts.size());
    parallelBlocks(lines.size(), num_threads,
                   [&](std::size_t i) { lines[i] = evidence_.refineLine(starts[i].line, fitAngles(starts[i].fold)); });
    eraseIf(lines, [](const Line3d& line) { return !line.direction().allFinite() || !line.origin().allFinite(); });
    return lines;
  }

  /// The best rotations about a line.
  std::optional<JudgedLine> judgeLine(const Line3d& line) const {
    const ScreenedShares screened{evidence_, line};
    std::optional<JudgedLine> best;
    const auto take = [&](const JudgedLine& judged) {
      if (!best || judged.margin > best->margin) best = judged;
    };
    if (kScreeningLimits.allow(worstRoundShares(screened, kScreeningLimits))) take(measureLine(line, 0));
    for (int fold = max_fold_; fold >= 2; --fold) {
      if (best && best->margin > 0.0) break;
      if (kScreeningLimits.allow(worstSharesOfFold(screened, fold, 0.0, kScreeningLimits)))
        take(measureLine(line, fold));
    }
    return best;
  }

  JudgedLine measureLine(Line3d line, int fold) const {
    line = evidence_.refineLineClosely(line, fitAngles(fold));
    const auto shares = [&](double angle) { return evidence_.measure(motionAbout(line, angle)); };
    const RotationShares own = fold == 0 ? worstRoundShares(shares) : worstSharesOfFold(shares, fold, 0.0);
    SymmetryRotation rotation{Eigen::Vector3d::Zero(), line.direction(), fold, 0.0, own.on, own.off, own.far, 0.0};
    if (fold > 0) rotation.halfway = worstSharesOfFold(shares, fold, 0.5).off;
    return {line, rotation, marginOf(rotation)};
  }

private:
  static std::vector<double> fitAngles(int fold) {
    if (fold == 0)
      return {kScanAxes.small_angle, -kScanAxes.small_angle, kScanAxes.larger_angle, -kScanAxes.larger_angle};
    const double step = 2.0 * kPi / fold;
    return fold == 2 ? std::vector<double>{step} : std::vector<double>{step, -step};
  }

  const RotationEvidence& evidence_;
  int max_fold_;
};

/// Planes that may be symmetries, normalized frame.
std::vector<ReflectionPlane> likelyPlanes(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud) {
  std::vector<ReflectionPlane> found;
  for (const SymmetryPlane& plane : planes)
    if (plane.kind != PlaneKind::Local && plane.share >= kScanAxes.plane_share &&
        found.size() < kScanAxes.max_planes_of_axes)
      found.push_back(cloud.toNormalized(plane));
  return found;
}

}  // namespace

std::vector<Line3d> linesOfNormals(const RotationEvidence& evidence, const DetectionOptions& options) {
  return AxisJudge(evidence, 1)
      .fitLines(startsFromNormals(evidence.cloud(), options.seed, options.num_threads), options.num_threads);
}

std::vector<SymmetryRotation> scanAxes(const RotationEvidence& evidence, const std::vector<Line3d>& lines,
                                       const std::vector<SymmetryPlane>& planes, const std::vector<SymmetryAxis>& axes,
                                       const DetectionOptions& options, std::vector<JudgedRotation>* evidence_of_all) {
  const NormalizedCloud& cloud = evidence.cloud();
  std::vector<AxisStart> starts;
  for (const SymmetryAxis& axis : axes) starts.push_back({cloud.lineOf(axis), 0});
  if (options.folds) {
    append(starts, startsFromPlanes(likelyPlanes(planes, cloud), kScanAxes.max_order));
    append(starts, startsFromTransform(cloud, options.seed, options.num_threads));
  }
  const AxisJudge judge(evidence, options.folds ? kScanAxes.max_order : 1);
  std::vector<Line3d> all = lines;
  append(all, judge.fitLines(starts, options.num_threads));
  all = kSameFitted.distinct(std::move(all));
  std::vector<std::optional<JudgedLine>> judged(all.size());
  parallelBlocks(all.size(), options.num_threads, [&](std::size_t i) { judged[i] = judge.judgeLine(all[i]); });
  std::stable_sort(judged.begin(), judged.end(),
                   [](const auto& a, const auto& b) { return a && (!b || a->margin > b->margin); });
  std::vector<Line3d> found;
  std::vector<SymmetryRotation> result;
  for (const std::optional<JudgedLine>& best : judged) {
    if (!best || found.size() == kScanAxes.max_axes) break;
    if (kSameAxis.anySame(found, best->line)) continue;
    found.push_back(best->line);
    result.push_back(best->rotation);
    result.back().point = cloud.toInput(best->line.projection(Eigen::Vector3d::Zero()));
  }
  const double min_confidence = evidence_of_all ? 0.0 : options.min_possible;
  const std::vector<HalfTurnEvidence> half_turns =
      halfTurnEvidence(evidence, result, min_confidence, options.num_threads);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i].confidence = rotationConfidence(result[i], half_turns[i]);
    if (evidence_of_all) evidence_of_all->push_back({result[i], half_turns[i]});
  }
  eraseIf(result, [&](const SymmetryRotation& rotation) { return rotation.confidence < options.min_possible; });
  sortDescending(result, &SymmetryRotation::confidence);
  return result;
}

std::optional<NearlyRound> nearlyRound(const RotationEvidence& evidence, const std::vector<Line3d>& lines) {
  const auto num_samples = std::min<Eigen::Index>(kScanAxes.num_samples, evidence.cloud().points.cols());
  for (const Line3d& axis : lines) {
    if (evidence.measure(motionAbout(axis, kScanAxes.small_angle)).on < kScanAxes.round_on) continue;
    std::vector<int> off_body = evidence.samplesOffBody(axis);
    const double share = static_cast<double>(off_body.size()) / static_cast<double>(num_samples);
    if (share > kScanAxes.max_round_far && share < kScanAxes.max_off_body)
      return NearlyRound{axis, std::move(off_body)};
  }
  return std::nullopt;
}

std::optional<SymmetryCenter> centerOfScan(const RotationEvidence& evidence, const DetectionOptions& options) {
  const NormalizedCloud& cloud = evidence.cloud();
  const std::vector<int> samples = drawSamples(cloud.points.cols(), kScanAxes.normal_samples, options.seed);
  const Eigen::Vector3d met = centerOfNormals(cloud.points, cloud.geometry.normals, samples);
  // The sphere through the points whose normals meet there: |x|^2 = 2 c.x + r^2 - |c|^2.
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const int i : samples) {
    const Eigen::Vector3d x = cloud.points.col(i).cast<double>(), d = x - met;
    if (d.cross(cloud.geometry.normals.col(i).cast<double>()).norm() > kGeometry.normal_miss * d.norm()) continue;
    const Eigen::Vector4d row = (2.0 * x).homogeneous();
    squares += row * row.transpose();
    sum += x.squaredNorm() * row;
  }
  const Eigen::Vector3d center = solveSymmetric(squares, sum).head<3>();
  if (!center.allFinite()) return std::nullopt;
  constexpr OffLimits limits{kScanAxes.max_round_off, kScanAxes.max_round_far};
  SymmetryRotation worst{center, Eigen::Vector3d::UnitX(), 0, 0.0, 1.0, 0.0, 0.0, 0.0};
  double score = 0.0;
  for (int k = 0; k < 3 && marginOf(worst) > 0.0; ++k) {
    const Line3d line(center, Eigen::Vector3d::Unit(k));
    if (!kScreeningLimits.allow(worstRoundShares(ScreenedShares{evidence, line}, kScreeningLimits)))
      return std::nullopt;
    const RotationShares all =
        worstRoundShares([&](double angle) { return evidence.measure(motionAbout(line, angle)); }, limits);
    worst.support = std::min(worst.support, all.on);
    worst.off = std::max(worst.off, all.off);
    worst.far = std::max(worst.far, all.far);
    score += cloud.score(cloud.toInput(ReflectionPlane(line.direction(), center[k]))) / 3.0;
  }
  const double confidence = rotationConfidence(worst, {});
  if (marginOf(worst) <= 0.0 || confidence < options.min_confidence) return std::nullopt;
  return SymmetryCenter{cloud.toInput(center), confidence, score, worst.support};
}

Detection rotationsOfScan(const PointsRef& points, const GaussianEdt& edt, const Visibility& visibility,
                          const std::vector<SymmetryAxis>& axes, const DetectionOptions& options,
                          const MakeSearch& make_search) {
  if (!whyUnanswerable(points).empty()) return {};
  const Points distinct = DistinctPoints(points).points;
  const Points used =
      pointsAt(distinct, drawSamples(distinct.cols(), ObjectSymmetryOptions().max_points, options.seed));
  const ClosestPointSearch::Ptr search = make_search ? inFrame(make_search(used), edt.center(), edt.radius()) : nullptr;
  const NormalizedCloud cloud(used, edt, search, &visibility, options.num_threads);
  const RotationEvidence evidence(cloud, ObjectSymmetryOptions().tolerance * cloud.diameter, options.seed);
  Detection found;
  if (const std::optional<SymmetryCenter> center = centerOfScan(evidence, options))
    found.centers.push_back(*center);
  else
    found.rotations = scanAxes(evidence, linesOfNormals(evidence, options), {}, axes, options);
  return found;
}

std::vector<SymmetryAxis> withRoundAxes(const RotationEvidence& evidence, std::vector<SymmetryAxis> axes,
                                        const std::vector<SymmetryRotation>& rotations,
                                        const DetectionOptions& options) {
  const NormalizedCloud& cloud = evidence.cloud();
  eraseIf(axes, [&](const SymmetryAxis& axis) {
    const RotationShares all =
        worstRoundShares([&](double angle) { return evidence.measure(motionAbout(cloud.lineOf(axis), angle)); });
    return all.far > kScanAxes.max_round_far;
  });
  for (const SymmetryRotation& rotation : rotations) {
    // A visible handle is a contradiction, however probable the axis is.
    const bool is_contradicted = rotation.off > kScanAxes.max_round_off || rotation.far > kScanAxes.max_round_far;
    if (rotation.fold != 0 || is_contradicted || rotation.confidence < options.min_confidence) continue;
    const auto known = std::find_if(axes.begin(), axes.end(), [&](const SymmetryAxis& axis) {
      return kSameAxis.same(cloud.lineOf(axis), cloud.lineOf(rotation));
    });
    if (known != axes.end()) {
      known->point = rotation.point;
      known->direction = rotation.direction;
    } else {
      double score = 0.0;
      for (int k = 0; k < kScanAxes.scored_planes; ++k)
        score += cloud.score(planeThrough({rotation.point, rotation.direction}, kPi * k / kScanAxes.scored_planes)) /
                 kScanAxes.scored_planes;
      axes.push_back({rotation.point, rotation.direction, rotation.confidence, score, rotation.support});
    }
  }
  return axes;
}

}  // namespace pcl_symmetry
