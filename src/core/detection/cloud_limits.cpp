#include "core/detection/cloud_limits.h"

#include <algorithm>
#include <cmath>

#include "core/detection/detection_rules.h"
#include "core/scan/single_view.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

namespace {

/// Distance from a line within which a cloud is that line: the tolerance, or two spacings where that is more. Noise of
/// a line of few points is wider than what they resolve.
double lineTolerance(CloudKind kind, const CloudLimits::Lengths& lengths) {
  const double noisy = kDetection.measure.noisy_thinness * lengths.tolerance;
  return kind == CloudKind::Volume
             ? noisy
             : std::clamp(kDetection.measure.round_spacings * lengths.spacing, lengths.tolerance, noisy);
}

/// Share of the points that a plane moves by more than a distance.
double movedShare(const ReflectionPlane& plane, const PointsRef& points, double distance) {
  Eigen::Index num_moved = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    num_moved += 2.0 * std::abs(plane.signedDistance(points.col(i).cast<double>())) > distance ? 1 : 0;
  return static_cast<double>(num_moved) / static_cast<double>(points.cols());
}

/// A sensor that resolves less than the tolerance decides at the greatest tolerance, if that counts.
bool isResolved(const CloudLimits::Lengths& lengths) {
  const double greatest = DetectionOptions().max_tolerance * lengths.diameter;
  return lengths.tolerance >= lengths.resolution ||
         (lengths.tolerance >= greatest && lengths.resolution <= kDetection.decide.coarsest * greatest);
}

}  // namespace

CloudLimits::CloudLimits(const PointsRef& points, const PrincipalAxes& axes, CloudKind kind, const Visibility* seen,
                         const Lengths& lengths)
    : is_resolved_(isResolved(lengths)),
      is_cut_(seen && lengths.resolution > 0.0 &&
              cutShare(points, *seen, kDetection.measure.beside_outline) > kDetection.decide.max_cut),
      still_(kKindRules.thin_tolerances[kind] * lengths.tolerance),
      thinness_(thinnessOf(points, axes, still_, lineTolerance(kind, lengths))) {}

bool CloudLimits::movesNothing(const ReflectionPlane& plane, const PointsRef& points) const {
  return thinness_ == Thinness::Sheet && movedShare(plane, points, still_) < 1.0 - kDetection.decide.max_unmoved_share;
}

std::vector<const char*> CloudLimits::of(const ReflectionPlane& plane, const PointsRef& points) const {
  std::vector<const char*> rules;
  if (!is_resolved_) rules.push_back("the sensor does not resolve the tolerance");
  if (is_cut_) rules.push_back("the border of the picture cuts the points off all around");
  if (thinness_ == Thinness::Line)
    rules.push_back("at the tolerance the points are a line");
  else if (movesNothing(plane, points))
    rules.push_back("the plane moves the points by no more than the tolerance");
  return rules;
}

}  // namespace pcl_symmetry
