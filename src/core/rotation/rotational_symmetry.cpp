#include "pcl_symmetry/core/rotation/rotational_symmetry.h"

#include <stdexcept>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/stopwatch.h"
#include "core/geometry/point_samples.h"
#include "core/neighbours/answerable_points.h"
#include "core/neighbours/distinct_points.h"
#include "core/rotation/greatest_group.h"
#include "core/rotation/rotation_fit.h"
#include "core/rotation/rotation_search.h"
#include "core/rotation/turning_axes.h"
#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

/// The direction across an axis that is closest to a coordinate axis.
Eigen::Vector3d directionAcross(const Eigen::Vector3d& axis) {
  int most_across = 0;
  axis.cwiseAbs().minCoeff(&most_across);
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(most_across);
  return (unit - axis.dot(unit) * axis).normalized();
}

/// A group of the normalised frame in the input frame.
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
      result.discrete.push_back(motion(rotationAbout(directionAcross(group.axis), kPi)));
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
  const RotationFit fit(normalized, edt, options.seed, options.num_threads);
  done("surface");
  const std::vector<AxisLineCandidate> lines =
      axisLineCandidates(fit, options.num_directions, options.max_fold, options.num_threads);
  done("search");
  const std::vector<TurningAxis> axes = turningAxes(fit, options, lines);
  done("axes");
  const PlacedGroup group = greatestGroup(fit, options, axes);
  done("group");

  ObjectSymmetries result = inInputFrame(group, ball);
  result.timing_ms = std::move(timing_ms);
  return result;
}

}  // namespace pcl_symmetry
