#include "core/detection/plane_fit.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/evidence/point_density.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/plane_chart.h"
#include "core/geometry/point_samples.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

namespace {

/// Planes of points that resolve a surface: Iterative Symmetric Points, and the share of points whose reflection lies
/// on the surface.
class SurfaceFit : public PlaneFit {
public:
  SurfaceFit(const NormalizedCloud& cloud, const DetectionOptions& options) : PlaneFit(cloud, options) {}

  std::vector<Candidate> refine(std::vector<Candidate> candidates, const RefinementStage& stage) const override {
    const auto samples = std::make_shared<const std::vector<int>>(drawn(stage.num_samples)),
               fewer = std::make_shared<const std::vector<int>>(drawn(stage.num_rough_samples));
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      Candidate& candidate = candidates[i];
      const bool settles = candidate.iterations == 0 || candidate.merit >= stage.min_merit;
      candidate.samples = settles ? samples : fewer;
      const std::vector<int>& used = *candidate.samples;
      const ReflectionPlane start = candidate.plane;
      // The first steps have wide weights. Scans have many borders, at which walks end beside the closest point.
      const IspSurface& surface = candidate.iterations == 0 && !cloud_.isScan() ? cloud_.quick_surface : cloud_.surface;
      IspResult result = refineSymmetricPoints(surface, used, start, settles ? stage.isp : stage.rough_isp);
      candidate.plane = result.plane;
      candidate.iterations += result.iterations;
      candidate.converged = result.converged;
      candidate.step = std::move(result.last);
      candidate.merit = merit(shares(candidate.plane, used, candidate.step));
      if (!stage.undo_slides) return;
      undoSlide(candidate, start, used, stage.isp.final_sigma);
      if (stage.climbs && cloud_.roughness > kDetection.fit.noisy_depth &&
          candidate.merit >= kDetection.fit.climbing_merit)
        climb(candidate, used, *fewer);
    });
    return candidates;
  }

  std::vector<char> climb(std::vector<Candidate>& candidates, const RefinementStage& stage,
                          const std::vector<char>& may_climb) const override {
    std::vector<char> moved(candidates.size(), false);
    const auto samples = std::make_shared<const std::vector<int>>(drawn(stage.num_samples));
    const std::vector<int> fewer = drawn(std::min(stage.num_rough_samples, kDetection.fit.climb_samples));
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      Candidate& candidate = candidates[i];
      // At a symmetry, no false pairs pull the plane away.
      const bool is_at_rest = candidate.merit >= kDetection.stages.symmetric_merit;
      moved[i] = may_climb[i] && candidate.merit >= kDetection.fit.climbing_merit && !is_at_rest &&
                 climb(candidate, *samples, fewer);
      if (moved[i]) candidate.samples = samples;
    });
    return moved;
  }

  ReflectionPlane refinePlane(const ReflectionPlane& plane, const std::vector<int>& samples) const override {
    IspOptions isp;
    isp.sigma = isp.final_sigma = cloud_.final_sigma;
    isp.max_iterations = kDetection.families.refine_iterations;
    return refineSymmetricPoints(cloud_.surface, samples, plane, isp).plane;
  }

  using PlaneFit::shares;
  PlaneShares shares(const ReflectionPlane& plane, const std::vector<int>& samples,
                     const IspStep& step) const override {
    PointEvidence evidence = pointEvidence(reflectedPoints(pointsAt(cloud_.points, samples), plane),
                                           reflectedNormals(pointsAt(cloud_.geometry.normals, samples), plane),
                                           step.closest, cloud_.samples, cloud_.seen(), options_.num_threads);
    return {meanSupport(evidence.support), meanSupport(evidence.conflict), std::move(evidence)};
  }

  double merit(const PlaneShares& shares) const override {
    return seenSymmetry(relativeSupport(shares), shares.conflict);
  }

private:
  std::vector<int> drawn(int num_samples) const {
    return drawSamples(cloud_.points.cols(), num_samples, options_.seed);
  }

  /// Point-to-plane distances are uninformative along flat pieces, which may be most of a scan. The plane takes one
  /// point-to-point step from its start instead if that has more merit.
  void undoSlide(Candidate& candidate, const ReflectionPlane& start, const std::vector<int>& samples,
                 double sigma) const {
    IspStep step =
        iterateSymmetricPoints(cloud_.surface, samples, start, sigma, IspUpdate::PointToPoint, &candidate.step.closest);
    const double point_to_point_merit = merit(shares(step.plane, samples, step));
    if (point_to_point_merit <= candidate.merit) return;
    candidate.plane = step.plane;
    candidate.merit = point_to_point_merit;
    candidate.step = std::move(step);
  }

  /// Pairs whose true partners were cut off or hidden by noise bias a plane: refinement ends beside the plane that
  /// explains most of the points. From there the plane climbs on the merit itself, along its three parameters.
  /// \param samples for the final merit.
  /// \param fewer samples by which the plane climbs.
  /// \return whether the plane moved.
  bool climb(Candidate& candidate, const std::vector<int>& samples, const std::vector<int>& fewer) const {
    ReflectionPlane plane = candidate.plane;
    IspStep here = matches(plane, fewer);
    double best = merit(shares(plane, fewer, here));
    int num_climbs = 0;
    for (double step = kDetection.fit.first_climb; step >= kDetection.fit.last_climb; step *= 0.5) {
      for (int fails = 0, k = 0; fails < 6 && num_climbs < kDetection.fit.max_climbs; k = (k + 1) % 6) {
        const PlaneChart chart(plane, Eigen::Vector3d::Zero());
        const ReflectionPlane next = chart.moved((k % 2 == 0 ? step : -step) * Eigen::Vector3d::Unit(k / 2));
        IspStep there = matches(next, fewer, &here.closest);
        const double value = merit(shares(next, fewer, there));
        ++fails;
        if (value <= best) continue;
        best = value;
        here = std::move(there);
        plane = next;
        ++num_climbs;
        fails = 0;
      }
    }
    if (num_climbs == 0) return false;
    IspStep step = matches(plane, samples);
    const double value = merit(shares(plane, samples, step));
    if (value <= candidate.merit + kDetection.fit.min_gain) return false;
    candidate.plane = plane;
    candidate.merit = value;
    candidate.step = std::move(step);
    return true;
  }
};

/// Planes of points that resolve no surface: the overlap of the points' density with its reflection.
class VolumeFit : public PlaneFit {
public:
  VolumeFit(const NormalizedCloud& cloud, const DetectionOptions& options)
      : PlaneFit(cloud, options),
        surface_(cloud, options),
        density_(cloud.points, kDetection.fit.bandwidth * cloud.spacing, options.num_threads) {}

  std::vector<Candidate> refine(std::vector<Candidate> candidates, const RefinementStage& stage) const override {
    const int num_samples =
        std::min(kDetection.fit.sample_factor * stage.num_samples, options_.expert.num_refine_samples);
    const Points samples = pointsAt(cloud_.points, drawSamples(cloud_.points.cols(), num_samples, options_.seed));
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      Candidate& candidate = candidates[i];
      const PointDensity::Refined refined = density_.refine(samples, candidate.plane, kDetection.fit.max_iterations);
      candidate.plane = refined.plane;
      candidate.converged = refined.iterations < kDetection.fit.max_iterations;
      candidate.iterations += refined.iterations;
      candidate.merit = density_.overlap(samples, candidate.plane);
    });
    return candidates;
  }

  ReflectionPlane refinePlane(const ReflectionPlane& plane, const std::vector<int>& samples) const override {
    return density_.refine(pointsAt(cloud_.points, samples), plane, kDetection.families.refine_iterations).plane;
  }

  using PlaneFit::shares;
  PlaneShares shares(const ReflectionPlane& plane, const std::vector<int>& samples,
                     const IspStep& step) const override {
    PlaneShares shares = surface_.shares(plane, samples, step);
    shares.support = density_.overlap(pointsAt(cloud_.points, samples), plane);
    shares.conflict = std::max(0.0, 1.0 - shares.support);
    return shares;
  }

  double merit(const PlaneShares& shares) const override { return shares.support; }

private:
  SurfaceFit surface_;  ///< gives the support of single points
  PointDensity density_;
};

}  // namespace

std::unique_ptr<PlaneFit> makePlaneFit(const NormalizedCloud& cloud, const DetectionOptions& options) {
  if (!cloud.isVolume()) return std::make_unique<SurfaceFit>(cloud, options);
  return std::make_unique<VolumeFit>(cloud, options);
}

std::vector<float> surfaceSupport(const NormalizedCloud& cloud, const ReflectionPlane& plane,
                                  const DetectionOptions& options) {
  return SurfaceFit(cloud, options).shares(plane, allIndices(cloud.points.cols())).points.seenSupport();
}

}  // namespace pcl_symmetry
