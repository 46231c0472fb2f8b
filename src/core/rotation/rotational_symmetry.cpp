#include "pcl_symmetry/core/rotational_symmetry.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/lists.h"
#include "core/base/stopwatch.h"
#include "core/geometry/cloud_extent.h"
#include "core/geometry/point_samples.h"
#include "core/rotation/rotation_axes.h"
#include "pcl_symmetry/core/gaussian_edt.h"

namespace pcl_symmetry {

namespace {

/// The direction perpendicular to an axis that is closest to a coordinate axis.
Eigen::Vector3d coordinateAcross(const Eigen::Vector3d& axis) {
  int max_across = 0;
  axis.cwiseAbs().minCoeff(&max_across);
  const Eigen::Vector3d unit = Eigen::Vector3d::Unit(max_across);
  return (unit - axis.dot(unit) * axis).normalized();
}

/// A group in the normalized frame, transformed to the input frame.
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
      result.discrete.push_back(motion(rotationAbout(coordinateAcross(group.axis), kPi)));
  } else {
    for (const Eigen::Matrix3d& rotation : group.set.rotations) result.discrete.push_back(motion(rotation));
  }
  return result;
}

/// The rejected rotations, transformed to the input frame, the least failure first.
std::vector<RejectedRotation> inInputFrame(std::vector<RejectedAxis> axes, const RotationFit& fit,
                                           const BoundingBall& ball) {
  sortAscending(axes, [&](const RejectedAxis& axis) { return fit.limits().excess(axis.shares); });
  const std::size_t max_reported = 5;
  if (axes.size() > max_reported) axes.resize(max_reported);
  std::vector<RejectedRotation> rejected;
  for (const RejectedAxis& axis : axes) {
    const Eigen::Matrix3d rotation = rotationAbout(axis.line.direction(), axis.angle);
    rejected.push_back({motionFixing(ball.center + ball.radius * axis.line.origin(), rotation), axis.line.direction(),
                        axis.fold, axis.shares.off, axis.shares.far,
                        ball.center + ball.radius * fit.whereOff(rotation, axis.line.origin())});
  }
  return rejected;
}

/// Finds the symmetry group of points, judged by their surface or point by point, at one or more tolerances.
class GroupSearch {
public:
  /// \param points normalized.
  /// \param options must outlive this object.
  GroupSearch(Points points, RotationLimits limits, const ObjectSymmetryOptions& options, bool single)
      : options_(options),
        edt_(points, {options.num_cells, 0.0, options.num_threads}),
        fit_(std::move(points), edt_, limits, (options.other_tolerances ? 2.0 : 1.0) * limits.tolerance, options.seed,
             options.num_threads, single),
        principal_(principalLines(fit_)) {}

  const RotationFit& fit() const { return fit_; }
  void limitTolerance(double tolerance) { max_tolerance_ = tolerance; }

  struct Found {
    PlacedGroup group;
    std::vector<RejectedAxis> rejected;
  };
  Found at(RotationLimits limits) {
    limits.tolerance = std::min(limits.tolerance, max_tolerance_);
    const RotationFit fit = fit_.withLimits(limits);
    AxisFinder finder(fit, options_);
    finder.judge(principal_);
    if (!finder.isRound()) {
      if (others_.empty())  // searched once for all tolerances
        others_ = axisLineCandidates(fit_, options_.num_directions, options_.max_fold, options_.num_threads);
      finder.judge(others_);
    }
    return {greatestGroup(fit, options_, finder.axes()), finder.rejected()};
  }

private:
  const ObjectSymmetryOptions& options_;
  GaussianEdt edt_;
  RotationFit fit_;
  std::vector<Line3d> principal_, others_;
  double max_tolerance_ = std::numeric_limits<double>::infinity();
};

/// The surface that points resolve or, if they fill a body, the surface of its border. Points that resolve no surface
/// at the tolerance may still meet each other one by one: atoms, grids, the corners of a solid.
/// \param[out] resolution the least tolerance at which the points show a surface.
/// \return null if the points resolve no answer.
std::unique_ptr<GroupSearch> searchThatResolves(const Points& points, const RotationLimits& limits,
                                                const ObjectSymmetryOptions& options, double& resolution) {
  const std::vector<int> drawn = drawSamples(points.cols(), options.max_points, options.seed);
  auto search = std::make_unique<GroupSearch>(pointsAt(points, drawn), limits, options, false);
  const bool fills_body = search->fit().fillsBody();
  if (fills_body) {
    const double distance = search->fit().closestDistance();  // the border of a body is about as thick
    search = std::make_unique<GroupSearch>(search->fit().borderPoints(), limits, options, false);
    resolution = std::max(distance, search->fit().resolution());
  } else {
    resolution = search->fit().resolution();
  }
  const bool is_resolved = resolution <= (fills_body ? 1.0 : kRotation.surface_slack) * limits.tolerance;
  if ((!is_resolved || fills_body) && points.cols() <= kRotation.max_single_points) {
    auto single = std::make_unique<GroupSearch>(points, limits, options, true);
    single->limitTolerance(kRotation.single_distance * single->fit().closestDistance());
    const PlacedGroup group = single->at(limits).group;
    if (group.kind != RotationGroupKind::Cyclic || group.fold > 1) return single;
  }
  return is_resolved ? std::move(search) : nullptr;
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

ObjectSymmetries objectSymmetries(const PointsRef& all, const ObjectSymmetryOptions& options) {
  options.validate();
  const Points points = withoutStrayPoints(all);
  if (const std::string reason = whyUnanswerable(points); !reason.empty())
    throw std::invalid_argument("points: " + reason);
  std::vector<std::pair<std::string, double>> timing_ms;
  StageTimes done(timing_ms);

  const Points distinct = DistinctPoints(points).points;
  const BoundingBall ball =
      boundingBall(pointsAt(distinct, drawSamples(distinct.cols(), options.max_points, options.seed)));
  const Points normalized = normalizePoints(distinct, ball.center, ball.radius);
  const double tolerance = options.absolute_tolerance > 0.0 ? options.absolute_tolerance / ball.radius
                                                            : options.tolerance * approximateDiameter(normalized);
  const RotationLimits limits{tolerance, options.max_feature};
  ObjectSymmetries result;
  double resolution = 0.0;
  const std::unique_ptr<GroupSearch> search = searchThatResolves(normalized, limits, options, resolution);
  done("surface");
  if (search) {
    const GroupSearch::Found found = search->at(limits);
    result = inInputFrame(found.group, search->fit(), ball);
    done("group");
    result.rejected = inInputFrame(found.rejected, search->fit(), ball);
    if (options.other_tolerances) {
      const auto nameAt = [&](double factor) {
        const PlacedGroup group = search->at({factor * tolerance, options.max_feature}).group;
        return GroupName{group.kind, group.fold};
      };
      result.at_half_tolerance = nameAt(0.5);
      result.at_twice_tolerance = nameAt(2.0);
      done("other_tolerances");
    }
  } else {
    char text[160];
    std::snprintf(text, sizeof(text), "the points show no surface at the tolerance %.4g, which must be at least %.4g",
                  tolerance * ball.radius, resolution * ball.radius);
    result.reason = text;
    result.center = ball.center;
    result.support = result.confidence = 0.0;
  }
  result.tolerance = tolerance * ball.radius;
  result.num_stray_points = static_cast<int>(all.cols() - points.cols());
  result.timing_ms = std::move(timing_ms);
  return result;
}

}  // namespace pcl_symmetry
