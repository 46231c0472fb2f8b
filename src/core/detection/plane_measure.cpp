#include "core/detection/plane_measure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/statistics.h"
#include "core/detection/detection_rules.h"
#include "core/evidence/plane_confidence.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/point_samples.h"
#include "core/scan/range_image.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

namespace {

/// Distance from a line within which a cloud counts as that line: the tolerance, or two spacings if that is more. The
/// noise of a few points on a line exceeds the tolerance.
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

/// Whether the sensor resolves the tolerance, or it is the greatest tolerance and three times that is resolved.
bool isResolved(const CloudLimits::Lengths& lengths) {
  const double greatest = DetectionOptions().max_tolerance * lengths.diameter;
  return lengths.tolerance >= lengths.resolution ||
         (lengths.tolerance >= greatest && lengths.resolution <= kDetection.decide.max_resolution * greatest);
}

std::array<double, 2> sharesWithin(const std::vector<float>& distances, double tolerance) {
  std::array<double, 2> shares{};
  for (std::size_t k = 0; k < shares.size(); ++k)
    shares[k] = std::max(kDetection.measure.min_own_share,
                         shareWithin(distances, kDetection.measure.tolerances[k] * tolerance));
  return shares;
}

/// The tolerance that the spacing of a surface resolves, up to the greatest one at which shares are measured; 0 for
/// points that resolve no surface.
double sampledTolerance(const NormalizedCloud& cloud, double tolerance) {
  if (cloud.isVolume()) return 0.0;
  return std::min(cloud.spacing / kEvidence.coarsest,
                  kDetection.measure.tolerances.back() * tolerance * cloud.diameter);
}

}  // namespace

CloudLimits::CloudLimits(const PointsRef& points, const PrincipalAxes& axes, CloudKind kind, const Visibility* seen,
                         const Lengths& lengths)
    : is_resolved_(isResolved(lengths)),
      is_cut_(seen && cutShare(points, *seen) > kDetection.decide.max_cut),
      still_((kind == CloudKind::Volume ? kDetection.measure.noisy_thinness : 1.0) * lengths.tolerance),
      thinness_(thinnessOf(points, axes, still_, lineTolerance(kind, lengths))),
      is_one_side_(seen && seen->supports().empty() && thinness_ == Thinness::Sheet &&
                   movedShare(principalPlanes(axes)[2], points, 2.0 * still_) < kDetection.decide.nothing_missing) {}

bool CloudLimits::leavesMostInPlace(const ReflectionPlane& plane, const PointsRef& points) const {
  return thinness_ == Thinness::Sheet && movedShare(plane, points, still_) < 1.0 - kDetection.decide.max_unmoved_share;
}

std::vector<const char*> CloudLimits::rulesAgainst(const ReflectionPlane& plane, const PointsRef& points) const {
  std::vector<const char*> rules;
  if (!is_resolved_) rules.push_back("the sensor does not resolve the tolerance");
  if (is_cut_) rules.push_back("the border of the picture cuts the points off all around");
  if (is_one_side_) rules.push_back("one flat side alone was seen");
  if (thinness_ == Thinness::Line)
    rules.push_back("at the tolerance the points are a line");
  else if (leavesMostInPlace(plane, points))
    rules.push_back("the plane moves the points by no more than the tolerance");
  return rules;
}

PlaneMeasure::PlaneMeasure(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options)
    : cloud_(cloud),
      fit_(fit),
      options_(options),
      resolution_(cloud.seen() ? cloud.seen()->resolvedTolerance(cloud.points) : 0.0),
      tolerance_(options.absolute_tolerance > 0.0
                     ? options.absolute_tolerance / cloud.scale
                     : std::max(options.tolerance * cloud.diameter,
                                std::min(std::max(resolution_, sampledTolerance(cloud, options.tolerance)),
                                         options.max_tolerance * cloud.diameter))),
      limits_(cloud.points, cloud.principal_axes, cloud.kind(), cloud.seen(),
              {tolerance_, resolution_, cloud.spacing, cloud.diameter}),
      halves_(cloud.isVolume() ? std::make_optional<SplitSurface>(cloud.points, options.seed, options.num_threads)
                               : std::nullopt),
      own_shares_(sharesWithin(
          halves_ ? halves_->ownDistances() : ownSurfaceDistances(cloud.samples, options.num_threads), tolerance_)),
      own_score_(halves_ ? halves_->ownScore(cloud.edt.numCells(), cloud.sigma, {Eigen::Vector3d::Zero(), 1.0},
                                             options.num_threads)
                         : 1.0) {}

std::vector<int> PlaneMeasure::samples() const {
  // Those of scans are the samples of the last stage, whose matches measureCandidate() uses again.
  return cloud_.isScan() ? drawSamples(cloud_.points.cols(),
                                       options_.expert.num_refine_samples / kKindRules.full_divisor.scan, options_.seed)
                         : allIndices(cloud_.points.cols());
}

MeasuredPlane PlaneMeasure::measureCandidate(const Candidate& candidate, const std::vector<int>& samples) const {
  // The last stage may have matched these very samples.
  const bool has_matches = candidate.samples && *candidate.samples == samples;
  const IspStep step = has_matches ? candidate.step : fit_.matches(candidate.plane, samples);
  MeasuredPlane result = measureMatched(candidate.plane, samples, step, 0.0);
  result.plane.iterations = candidate.iterations;
  result.plane.converged = candidate.converged;
  return result;
}

MeasuredPlane PlaneMeasure::measurePlane(const ReflectionPlane& plane, const std::vector<int>& samples,
                                         double rim) const {
  return measureMatched(plane, samples, fit_.matches(plane, samples), rim);
}

PlaneEvidence PlaneMeasure::evidenceOf(double support, double conflict, double score) const {
  PlaneEvidence evidence;
  evidence.support = support;
  evidence.conflict = conflict;
  evidence.score = score;
  evidence.baseline = fit_.baseline();
  evidence.spacing = cloud_.spacing;
  evidence.roughness = cloud_.roughness;
  evidence.kind = cloud_.kind();
  evidence.tolerance = tolerance_;
  evidence.own_score = own_score_;
  evidence.flat = limits_.thinness() == Thinness::Sheet;
  if (options_.absolute_tolerance == 0.0)
    evidence.tolerance_raise =
        std::max(0.0, tolerance_ / std::max(resolution_, options_.tolerance * cloud_.diameter) - 1.0);
  return evidence;
}

Landing PlaneMeasure::landingOf(const ReflectionPlane& plane, const std::vector<int>& samples,
                                std::vector<int> closest) const {
  Landing landing;
  landing.images = reflectedPoints(pointsAt(cloud_.points, samples), plane);
  landing.closest = std::move(closest);
  landing.distances = surfaceDistances(landing.images, landing.closest, cloud_.samples, options_.num_threads);
  return landing;
}

std::vector<float> PlaneMeasure::unknownMatches(const Landing& landing, const std::vector<char>& matched,
                                                double offset_stiffness, double rim) const {
  const std::size_t size = matched.size();
  std::vector<float> unknown(size, 0.0f);
  if (cloud_.seen()) {
    for (std::size_t i = 0; i < size; ++i)
      if (!matched[i]) {
        const Eigen::Vector3d x = landing.images.col(i).cast<double>();
        // The camera's measurements beside an object have errors, too.
        const double width = std::isfinite(cloud_.seen()->depthBehind(x)) ? std::max(rim, resolution_) : rim;
        unknown[i] = isFreeSpace(*cloud_.seen(), x, 0.0, width) ? 1.0f - freeConfidence(*cloud_.seen(), x) : 1.0f;
      }
    return unknown;
  }
  const double held = std::clamp(offset_stiffness / kDetection.measure.held_stiffness - 1.0, 0.0, 1.0);
  if (held <= 0.0 || static_cast<Eigen::Index>(size) != cloud_.points.cols()) return unknown;
  const auto trust = static_cast<float>(held * ends().trust);
  if (trust <= 0.0f) return unknown;
  unknown = missingCounterparts({cloud_.points, cloud_.geometry, ends().borders, cloud_.spacing}, matched,
                                landing.closest, landing.images);
  for (float& value : unknown) value *= trust;
  return unknown;
}

MeasuredPlane PlaneMeasure::measureMatched(const ReflectionPlane& plane, const std::vector<int>& samples,
                                           const IspStep& step, double rim) const {
  const Landing landing = landingOf(plane, samples, step.closest);
  const std::size_t size = samples.size();
  std::vector<char> matched(size), is_moved(size);
  // Distances of the samples whose position is informative; in scans, of those that the plane moves.
  std::vector<float> moved;
  for (std::size_t i = 0; i < size; ++i) {
    matched[i] = landing.distances[i] <= tolerance_;
    const Eigen::Vector3d x = landing.images.col(i).cast<double>();
    is_moved[i] =
        !cloud_.isScan() || 2.0 * std::abs(plane.signedDistance(x)) > kDetection.measure.moved_tolerances * tolerance_;
    if (is_moved[i]) moved.push_back(landing.distances[i]);
  }
  if (halves_) moved = halves_->reflectedDistances(plane);
  std::array<double, 2> within{};
  for (std::size_t k = 0; k < within.size() && !moved.empty(); ++k)
    within[k] = std::min(1.0, shareWithin(moved, kDetection.measure.tolerances[k] * tolerance_) / own_shares_[k]);
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  std::vector<float> unknown(size, 0.0f);
  if (cloud_.isScan() || (cloud_.isSurface() && within[0] < kDetection.measure.surely_whole)) {
    std::vector<int> matches = landing.closest;
    for (int& match : matches) match = std::max(0, match);
    stiffness = motionStiffness(landing.images, pointsAt(cloud_.geometry.normals, matches), matched, plane);
    unknown = unknownMatches(landing, matched, offsetStiffness(stiffness), rim);
  }
  std::vector<float> informative;  // distances of the informative samples
  std::size_t num_informative = 0;
  std::array<double, 2> missing{};
  const double count = static_cast<double>(halves_ ? size : std::max<std::size_t>(1, moved.size()));
  for (std::size_t i = 0; i < size; ++i) {
    if (unknown[i] < 0.5f) informative.push_back(landing.distances[i]);
    num_informative += unknown[i] < 0.5f && is_moved[i] ? 1 : 0;
    for (std::size_t k = 0; k < missing.size(); ++k)
      if (landing.distances[i] > kDetection.measure.tolerances[k] * tolerance_) missing[k] += unknown[i] / count;
  }
  const auto share = [&](std::size_t k) {
    const double good = within[k], bad = std::max(0.0, 1.0 - good - missing[k]);
    return good + bad > 0.0 ? good / (good + bad) : 0.0;
  };

  PlaneShares shares = fit_.shares(plane, samples, step);
  MeasuredPlane result;
  result.plane = SymmetryPlane(cloud_.toInput(plane));
  PlaneEvidence& evidence = result.evidence;
  evidence = evidenceOf(shares.support, shares.conflict, cloud_.score(result.plane));
  evidence.double_share = share(1);
  // A point within the tolerance is also within twice the tolerance. But if few points make the own share at the
  // tolerance small, the share at the tolerance can come out greater.
  evidence.share = std::min(share(0), share(1));
  evidence.stiffness = secondStiffness(stiffness);
  evidence.unknown = mean(unknown);
  result.informative = cloud_.isScan() ? static_cast<double>(num_informative) / static_cast<double>(size) : 1.0;
  const ShareInterval interval = shareInterval(evidence);
  result.plane.score = evidence.score;
  result.plane.support = seenSupport(evidence);
  result.plane.share = evidence.share;
  result.plane.share_low = interval.low;
  result.plane.share_high = interval.high;
  result.plane.deviation = deviationOf(std::move(halves_ ? moved : informative)) * cloud_.scale;
  result.plane.seen = cloud_.isScan() ? std::min(1.0, shares.support + shares.conflict) : 1.0 - evidence.unknown;
  result.plane.point_support = shares.points.seenSupport();
  result.plane.residual = step.residual * cloud_.scale;
  return result;
}

double PlaneMeasure::deviationOf(std::vector<float> distances) const {
  if (distances.empty()) return 0.0;
  const float last = quantile(std::move(distances), kSymmetricShare * std::min(1.0, own_shares_[0]));
  return std::isfinite(last) ? last : cloud_.diameter;
}

double PlaneMeasure::deviation(const ReflectionPlane& plane) const {
  if (halves_) return deviationOf(halves_->reflectedDistances(plane));
  const std::vector<int> samples =
      drawSamples(cloud_.points.cols(), kDetection.measure.screening_samples, options_.seed);
  const Landing landing =
      landingOf(plane, samples, cloud_.search->closest(reflectedPoints(pointsAt(cloud_.points, samples), plane)));
  std::vector<char> matched;
  for (const float distance : landing.distances) matched.push_back(distance <= tolerance_);
  const std::vector<float> unknown = unknownMatches(landing, matched, 0.0, 0.0);
  std::vector<float> informative;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (unknown[i] < 0.5f) informative.push_back(landing.distances[i]);
  return deviationOf(std::move(informative));
}

double PlaneMeasure::greatestShare(const Candidate& candidate) const {
  const std::vector<int> samples =
      drawSamples(cloud_.points.cols(), kDetection.measure.screening_samples, options_.seed);
  const Landing landing = landingOf(candidate.plane, samples, fit_.matches(candidate.plane, samples).closest);
  const double share = std::min(1.0, shareWithin(landing.distances, tolerance_) / own_shares_[0]);
  return share +
         kDetection.decide.screening_errors * std::sqrt(share * (1.0 - share) / static_cast<double>(samples.size()));
}

const SurfaceEnds& PlaneMeasure::ends() const {
  std::call_once(ends_found_, [this] {
    ends_.emplace(cloud_.points, cloud_.geometry, *cloud_.search, cloud_.neighbors, options_.num_threads);
  });
  return *ends_;
}

}  // namespace pcl_symmetry
