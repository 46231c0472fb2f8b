#include "pcl_symmetry/core/rotational_symmetry.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/stopwatch.h"
#include "core/geometry/answerable_points.h"
#include "core/geometry/diameter.h"
#include "core/geometry/distinct_points.h"
#include "core/geometry/point_samples.h"
#include "core/rotation/rotation_axes.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

/// The direction across an axis that is closest to a coordinate axis.
Eigen::Vector3d directionAcross(const Eigen::Vector3d& axis) {
  int most_across = 0;
  axis.cwiseAbs().minCoeff(&most_across);
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(most_across);
  return (unit - axis.dot(unit) * axis).normalized();
}

/// A group of the normalized frame in the input frame.
ObjectSymmetries inInputFrame(const PlacedGroup& group, const RotationFit& fit, const BoundingBall& ball) {
  ObjectSymmetries result;
  result.kind = group.kind;
  result.fold = group.fold;
  result.center = ball.center + ball.radius * group.set.center;
  if (group.kind == RotationGroupKind::Cyclic && group.fold == 1) return result;
  result.support = 1.0 - group.shares.off;
  result.confidence = fit.confidence(group.shares);
  const auto motion = [&](const Eigen::Matrix3d& rotation) { return motionFixing(result.center, rotation); };
  if (group.kind == RotationGroupKind::Spherical) {
    for (int k = 0; k < 3; ++k) result.continuous.push_back({Eigen::Vector3d::Unit(k), result.center});
  } else if (isContinuous(group.kind)) {
    result.continuous.push_back({signedDirection(group.axis), result.center});
    if (group.kind == RotationGroupKind::Cylindrical)
      result.discrete.push_back(motion(rotationAbout(directionAcross(group.axis), kPi)));
  } else {
    for (const Eigen::Matrix3d& rotation : group.set.rotations) result.discrete.push_back(motion(rotation));
  }
  return result;
}

/// What was tried and failed in the input frame, the least failure first.
std::vector<RejectedRotation> inInputFrame(std::vector<RejectedAxis> axes, const RotationFit& fit,
                                           const BoundingBall& ball) {
  std::stable_sort(axes.begin(), axes.end(), [&](const RejectedAxis& a, const RejectedAxis& b) {
    return fit.limits().excess(a.shares) < fit.limits().excess(b.shares);
  });
  const std::size_t max_reported = 5;
  if (axes.size() > max_reported) axes.resize(max_reported);
  std::vector<RejectedRotation> rejected;
  for (const RejectedAxis& axis : axes) {
    const Eigen::Matrix3d rotation = rotationAbout(axis.line.direction(), axis.angle);
    RejectedRotation entry;
    entry.motion = motionFixing(ball.center + ball.radius * axis.line.origin(), rotation);
    entry.axis = axis.line.direction();
    entry.fold = axis.fold;
    entry.off = axis.shares.off;
    entry.far = axis.shares.far;
    entry.where = ball.center + ball.radius * fit.whereOff(rotation, axis.line.origin());
    rejected.push_back(entry);
  }
  return rejected;
}

}  // namespace

void ObjectSymmetryOptions::validate() const {
  check(num_cells >= 8 && num_cells <= 512, "num_cells", num_cells, "in [8, 512]");
  check(num_directions >= 100, "num_directions", num_directions, ">= 100");
  check(max_fold >= 2, "max_fold", max_fold, ">= 2");
  check(max_points >= 100, "max_points", max_points, ">= 100");
  check(tolerance > 0.0 && tolerance <= 0.1, "tolerance", tolerance, "in (0, 0.1]");
  check(absolute_tolerance >= 0.0, "absolute_tolerance", absolute_tolerance, ">= 0");
  check(max_feature >= 0.0 && max_feature <= 1.0, "max_feature", max_feature, "in [0, 1]");
  check(min_confidence >= 0.0 && min_confidence <= 1.0, "min_confidence", min_confidence, "in [0, 1]");
  checkNumThreads(num_threads);
}

ObjectSymmetries objectSymmetries(const PointsRef& points, const ObjectSymmetryOptions& options) {
  options.validate();
  if (const std::string reason = whyUnanswerable(points); !reason.empty())
    throw std::invalid_argument("points: " + reason);
  std::vector<std::pair<std::string, double>> timing_ms;
  Stopwatch watch;
  const auto done = [&](const char* stage) { timing_ms.emplace_back(stage, watch.lap()); };

  const Points distinct = DistinctPoints(points).points;
  const Points used = pointsAt(distinct, drawSamples(distinct.cols(), options.max_points, options.seed));
  const BoundingBall ball = boundingBall(used);
  const Points normalized = normalizePoints(used, ball.center, ball.radius);
  GaussianEdtOptions edt_options;
  edt_options.num_cells = options.num_cells;
  edt_options.num_threads = options.num_threads;
  const GaussianEdt edt(normalized, edt_options);
  const double tolerance = options.absolute_tolerance > 0.0 ? options.absolute_tolerance / ball.radius
                                                            : options.tolerance * farthestPair(normalized);
  const RotationLimits limits{tolerance, options.max_feature};
  const double reach = (options.other_tolerances ? 2.0 : 1.0) * tolerance;
  const RotationFit fit(normalized, edt, limits, reach, options.seed, options.num_threads);
  done("surface");
  const std::vector<Line3d> principal = principalLines(fit);
  std::vector<Line3d> others;  // searched once for all tolerances
  const auto search = [&](const RotationFit& at) {
    AxisFinder finder(at, options);
    finder.judge(principal);
    if (finder.isRound()) return finder;
    if (others.empty()) others = axisLineCandidates(fit, options.num_directions, options.max_fold, options.num_threads);
    finder.judge(others);
    return finder;
  };
  const AxisFinder found = search(fit);
  ObjectSymmetries result = inInputFrame(greatestGroup(fit, options, found.axes()), fit, ball);
  done("group");
  result.tolerance = tolerance * ball.radius;
  result.rejected = inInputFrame(found.rejected(), fit, ball);
  if (options.other_tolerances) {
    const auto name_at = [&](double factor) {
      const RotationFit at = fit.withLimits({factor * tolerance, options.max_feature});
      const PlacedGroup group = greatestGroup(at, options, search(at).axes());
      return GroupName{group.kind, group.fold};
    };
    result.at_half_tolerance = name_at(0.5);
    result.at_twice_tolerance = name_at(2.0);
    done("other tolerances");
  }
  result.timing_ms = std::move(timing_ms);
  return result;
}

}  // namespace pcl_symmetry
