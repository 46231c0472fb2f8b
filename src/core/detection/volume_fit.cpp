#include "core/detection/volume_fit.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

// Spacings. chosen: at half, the density shows single points; at twice, it blurs the shape itself.
constexpr double kBandwidth = 1.5;
// chosen: Newton steps double the digits once they are near; half as many leave distant starts behind, twice as many
// only cost time.
constexpr int kMaxIterations = 6;
// Samples per sample of a surface. chosen: a look-up in the density costs about a tenth of a search for the closest
// point; with more, a stage takes longer than that of a surface, with fewer its samples are noisier than need be.
constexpr int kSampleFactor = 10;
// Share of the overlap, which varies less from plane to plane than the support of a surface does, at this number of
// points and more; fewer vary by more. chosen: at a third, sampling noise breaks up round bodies with noise of two
// spacings; what passes is judged by halves of the cloud.
constexpr double kVolumeAllowance = 0.012, kPointsOfAllowance = 10'000;

}  // namespace

VolumeFit::VolumeFit(const NormalizedCloud& cloud, const PlaneFitOptions& options)
    : PlaneFit(cloud),
      options_(options),
      surface_(cloud, options),
      density_(cloud.points, kBandwidth * cloud.spacing, options.num_threads) {}

void VolumeFit::refine(std::vector<Candidate>& candidates, const RefinementStage& stage) const {
  const int num_samples = std::min(kSampleFactor * stage.num_samples, options_.max_samples);
  const Points samples = pointsAt(cloud_.points, drawSamples(cloud_.points.cols(), num_samples, options_.seed));
  const int max_iterations = std::min(kMaxIterations, options_.max_iterations);
  parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
    Candidate& candidate = candidates[i];
    const PointDensity::Refined refined = density_.refine(samples, candidate.plane, max_iterations);
    candidate.plane = refined.plane;
    candidate.last.converged = refined.iterations < max_iterations;
    candidate.iterations += refined.iterations;
    candidate.merit = density_.overlap(samples, candidate.plane);
  });
}

ReflectionPlane VolumeFit::refined(const ReflectionPlane& plane, const std::vector<int>& samples,
                                   int max_iterations) const {
  return density_.refine(pointsAt(cloud_.points, samples), plane, max_iterations).plane;
}

PlaneShares VolumeFit::shares(const ReflectionPlane& plane, const std::vector<int>& samples,
                              const IspStep& step) const {
  PlaneShares shares = surface_.shares(plane, samples, step);
  shares.support = density_.overlap(pointsAt(cloud_.points, samples), plane);
  shares.conflict = std::max(0.0, 1.0 - shares.support);
  return shares;
}

double VolumeFit::relativeSupport(const PlaneShares& shares) const {
  return std::min(1.0, shares.support);
}

double VolumeFit::merit(const PlaneShares& shares) const {
  return shares.support;
}

double VolumeFit::familyAllowance() const {
  return kVolumeAllowance * std::sqrt(std::max(1.0, kPointsOfAllowance / static_cast<double>(cloud_.points.cols())));
}

PlaneEvidence VolumeFit::evidence(double support, double conflict, double score) const {
  PlaneEvidence evidence = surface_.evidence(support, conflict, score);
  evidence.baseline = 1.0;
  return evidence;
}

std::unique_ptr<PlaneFit> makePlaneFit(const NormalizedCloud& cloud, const PlaneFitOptions& options) {
  if (cloud.kind() == CloudKind::Volume) return std::make_unique<VolumeFit>(cloud, options);
  return std::make_unique<SurfaceFit>(cloud, options);
}

}  // namespace pcl_symmetry
