#include "core/detection/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/lists.h"
#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/geometry/plane_chart.h"
#include "core/geometry/point_samples.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

namespace {

bool isSymmetry(const Candidate& candidate) {
  return candidate.merit >= kDetection.stages.symmetric_merit;
}

}  // namespace

PlaneShares surfaceShares(const NormalizedCloud& cloud, const ReflectionPlane& plane, const std::vector<int>& samples,
                          const std::vector<int>& closest) {
  PointEvidence evidence = pointEvidence(reflectedPoints(pointsAt(cloud.points, samples), plane),
                                         reflectedNormals(pointsAt(cloud.geometry.normals, samples), plane), closest,
                                         cloud.samples, cloud.seen(), cloud.surface.num_threads);
  return {mean(evidence.support), mean(evidence.conflict), std::move(evidence)};
}

PlaneFit::PlaneFit(const NormalizedCloud& cloud, const DetectionOptions& options) : cloud_(cloud), options_(options) {
  if (cloud.isVolume()) density_.emplace(cloud.points, kDetection.fit.bandwidth * cloud.spacing, options.num_threads);
}

std::vector<Candidate> PlaneFit::refineCoarsely(std::vector<Candidate> candidates, const PlaneGrid& grid) const {
  const std::vector<Candidate> moved = refine(candidates, stage(kDetection.stages.first_samples, cloud_.sigma,
                                                                coarseSigma(), kDetection.stages.coarse_iterations));
  return distinct(withinCells(moved, candidates, grid), kDetection.stages.kept_coarsely);
}

std::vector<Candidate> PlaneFit::refineClosely(std::vector<Candidate> candidates) const {
  const bool keeps_all = cloud_.isScan() || options_.approximate;
  const auto likely =
      keeps_all ? candidates.end()
                : std::stable_partition(candidates.begin(), candidates.end(), [](const Candidate& candidate) {
                    return candidate.merit >= kDetection.stages.symmetric_merit - kDetection.stages.coarse_slack;
                  });
  std::vector<Candidate> found = refine({candidates.begin(), likely}, closeStage());
  // Once a whole cloud has a symmetry, candidates of much less merit are dropped.
  if (!keeps_all && std::any_of(found.begin(), found.end(), isSymmetry)) return distinct(std::move(found), 0);
  append(found, refine({likely, candidates.end()}, closeStage()));
  const bool is_whole = std::any_of(found.begin(), found.end(), isSymmetry);
  return distinct(std::move(found), keeps_all || !is_whole ? kDetection.stages.kept_closely : 0);
}

std::vector<Candidate> PlaneFit::refineImplied(std::vector<Candidate> candidates) const {
  return distinct(refine(std::move(candidates), closeStage()), kDetection.stages.kept_closely,
                  kDetection.stages.symmetric_merit - kDetection.stages.close_slack);
}

std::vector<Candidate> PlaneFit::refineFully(std::vector<Candidate> candidates) const {
  return refine(std::move(candidates), fullStage());
}

std::vector<char> PlaneFit::climb(std::vector<Candidate>& candidates, const std::vector<char>& may_climb) const {
  std::vector<char> moved(candidates.size(), false);
  if (!cloud_.isSurface()) return moved;
  const Stage stage = fullStage();
  const auto samples = std::make_shared<const std::vector<int>>(drawn(stage.num_samples));
  const std::vector<int> fewer = drawn(std::min(stage.num_rough_samples, kDetection.fit.climb_samples));
  parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
    Candidate& candidate = candidates[i];
    // At a symmetry, no false pairs pull the plane away.
    moved[i] = may_climb[i] && candidate.merit >= kDetection.fit.climbing_merit && !isSymmetry(candidate) &&
               climb(candidate, *samples, fewer);
    if (moved[i]) candidate.samples = samples;
  });
  return moved;
}

std::vector<Candidate> PlaneFit::distinct(std::vector<Candidate> candidates, std::size_t max_count,
                                          double min_merit) const {
  sortDescending(candidates, &Candidate::merit);
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    if (candidate.merit < min_merit) break;
    if (candidate.merit < kDetection.stages.symmetric_merit - kDetection.stages.close_slack && kept.size() >= max_count)
      break;
    if (!kSamePlane.anySame(kept, candidate.plane, &Candidate::plane)) kept.push_back(std::move(candidate));
  }
  return kept;
}

ReflectionPlane PlaneFit::refinePlane(const ReflectionPlane& plane, const std::vector<int>& samples) const {
  const int max_iterations = kDetection.fit.max_iterations;
  if (density_) return density_->refine(pointsAt(cloud_.points, samples), plane, max_iterations).plane;
  IspOptions isp;
  isp.sigma = isp.final_sigma = cloud_.final_sigma;
  isp.max_iterations = max_iterations;
  return refineSymmetricPoints(cloud_.surface, samples, plane, isp).plane;
}

PlaneShares PlaneFit::shares(const ReflectionPlane& plane, const std::vector<int>& samples, const IspStep& step) const {
  PlaneShares shares = surfaceShares(cloud_, plane, samples, step.closest);
  if (!density_) return shares;
  shares.support = density_->overlap(pointsAt(cloud_.points, samples), plane);
  shares.conflict = std::max(0.0, 1.0 - shares.support);
  return shares;
}

double PlaneFit::merit(const PlaneShares& shares) const {
  return density_ ? shares.support : seenSymmetry(relativeSupport(shares), shares.conflict);
}

double PlaneFit::coarseSigma() const {
  return std::clamp(cloud_.final_sigma, kDetection.stages.narrowest_coarsely * cloud_.sigma, cloud_.sigma);
}

PlaneFit::Stage PlaneFit::fullStage() const {
  Stage full = stage(options_.expert.num_refine_samples / kKindRules.full_divisor[cloud_.kind()], cloud_.final_sigma,
                     cloud_.final_sigma, kDetection.stages.full_iterations);
  full.climbs = true;
  return full;
}

PlaneFit::Stage PlaneFit::closeStage() const {
  Stage close = stage(std::min(kDetection.stages.close_sample_factor * kDetection.stages.first_samples,
                               options_.expert.num_refine_samples),
                      coarseSigma(), cloud_.final_sigma, kDetection.stages.close_iterations);
  // On the way to narrow weights, point-to-plane steps would slide a scan along its flat pieces.
  if (cloud_.isScan() && close.isp.final_sigma < close.isp.sigma)
    close.isp.update = close.rough_isp.update = IspUpdate::PointToPoint;
  return close;
}

PlaneFit::Stage PlaneFit::stage(int num_samples, double sigma, double final_sigma, int max_iterations) const {
  Stage stage;
  stage.num_samples = std::max(1, num_samples);
  stage.num_rough_samples =
      std::clamp(options_.expert.num_refine_samples / kKindRules.rough_divisor[cloud_.kind()], 1, stage.num_samples);
  // For sparse points, the weights have their least width from the first stage on.
  stage.undo_slides = cloud_.isScan() && final_sigma == sigma;
  stage.isp.sigma = sigma;
  stage.isp.final_sigma = final_sigma;
  stage.isp.max_iterations = max_iterations;
  stage.rough_isp = stage.isp;
  stage.rough_isp.max_iterations = std::min(stage.isp.max_iterations, kDetection.stages.rough_iterations);
  stage.isp.settled_errors = kDetection.stages.settled_errors;
  return stage;
}

std::vector<int> PlaneFit::drawn(int num_samples) const {
  return drawSamples(cloud_.points.cols(), num_samples, options_.seed);
}

std::vector<Candidate> PlaneFit::refine(std::vector<Candidate> candidates, const Stage& stage) const {
  if (density_) {
    const int max_iterations = kDetection.fit.max_iterations;
    const Points samples =
        pointsAt(cloud_.points,
                 drawn(std::min(kDetection.fit.sample_factor * stage.num_samples, options_.expert.num_refine_samples)));
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      Candidate& candidate = candidates[i];
      const PointDensity::Refined refined = density_->refine(samples, candidate.plane, max_iterations);
      candidate.plane = refined.plane;
      candidate.converged = refined.iterations < max_iterations;
      candidate.iterations += refined.iterations;
      candidate.merit = density_->overlap(samples, candidate.plane);
    });
    return candidates;
  }
  const auto samples = std::make_shared<const std::vector<int>>(drawn(stage.num_samples)),
             fewer = std::make_shared<const std::vector<int>>(drawn(stage.num_rough_samples));
  parallelBlocks(candidates.size(), options_.num_threads,
                 [&](std::size_t i) { refineOnSurface(candidates[i], stage, samples, fewer); });
  return candidates;
}

void PlaneFit::refineOnSurface(Candidate& candidate, const Stage& stage,
                               const std::shared_ptr<const std::vector<int>>& samples,
                               const std::shared_ptr<const std::vector<int>>& fewer) const {
  const bool is_likely = candidate.iterations == 0 || candidate.merit >= kKindRules.likely_merit[cloud_.kind()];
  candidate.samples = is_likely ? samples : fewer;
  const ReflectionPlane start = candidate.plane;
  // The first steps have wide weights. Scans have many borders, at which walks end beside the closest point.
  const IspSurface& surface = candidate.iterations == 0 && !cloud_.isScan() ? cloud_.quick_surface : cloud_.surface;
  IspResult result = refineSymmetricPoints(surface, *candidate.samples, start, is_likely ? stage.isp : stage.rough_isp);
  candidate.plane = result.plane;
  candidate.iterations += result.iterations;
  candidate.converged = result.converged;
  candidate.step = std::move(result.last);
  candidate.merit = merit(shares(candidate.plane, *candidate.samples, candidate.step));
  if (!stage.undo_slides) return;
  undoSlide(candidate, start, stage.isp.final_sigma);
  if (stage.climbs && cloud_.roughness > kDetection.fit.noisy_depth && candidate.merit >= kDetection.fit.climbing_merit)
    climb(candidate, *candidate.samples, *fewer);
}

/// Point-to-plane distances are uninformative along flat pieces, which may be most of a scan. The plane takes one
/// point-to-point step from its start instead if that has more merit.
void PlaneFit::undoSlide(Candidate& candidate, const ReflectionPlane& start, double sigma) const {
  const std::vector<int>& samples = *candidate.samples;
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
bool PlaneFit::climb(Candidate& candidate, const std::vector<int>& samples, const std::vector<int>& fewer) const {
  ReflectionPlane plane = candidate.plane;
  IspStep here = matches(plane, fewer);
  double best = merit(shares(plane, fewer, here));
  int num_steps = 0;
  for (double step = kDetection.fit.first_climb; step >= kDetection.fit.last_climb; step *= 0.5) {
    for (int fails = 0, k = 0; fails < 6 && num_steps < kDetection.fit.max_climb_steps; k = (k + 1) % 6) {
      const PlaneChart chart(plane, Eigen::Vector3d::Zero());
      const ReflectionPlane next = chart.moved((k % 2 == 0 ? step : -step) * Eigen::Vector3d::Unit(k / 2));
      IspStep there = matches(next, fewer, &here.closest);
      const double value = merit(shares(next, fewer, there));
      ++fails;
      if (value <= best) continue;
      best = value;
      here = std::move(there);
      plane = next;
      ++num_steps;
      fails = 0;
    }
  }
  if (num_steps == 0) return false;
  IspStep step = matches(plane, samples);
  const double value = merit(shares(plane, samples, step));
  if (value <= candidate.merit + kDetection.fit.min_gain) return false;
  candidate.plane = plane;
  candidate.merit = value;
  candidate.step = std::move(step);
  return true;
}

/// The candidates that stayed near the cell they came from. Departure from the paper: it drops all candidates that
/// leave their cell. Here maxima of a map of few samples are up to one cell off, hence kDetection.stages.max_drift, and
/// candidates that map more of the shape than all that stayed are kept.
std::vector<Candidate> PlaneFit::withinCells(const std::vector<Candidate>& candidates,
                                             const std::vector<Candidate>& starts, const PlaneGrid& grid) const {
  const double reach = 0.5 + kDetection.stages.max_drift;
  const MergeTolerance cell{std::sqrt(2.0) * reach * std::max(grid.thetaStep(), grid.phiStep()),
                            reach * grid.radiusStep() / cloud_.scale};
  std::vector<Candidate> kept, left;
  double best = 0.0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool stays = !candidates[i].from_map || cell.same(starts[i].plane, candidates[i].plane);
    (stays ? kept : left).push_back(candidates[i]);
    if (stays) best = std::max(best, candidates[i].merit);
  }
  for (const Candidate& candidate : left)
    if (!cloud_.isScan() && candidate.merit > best) kept.push_back(candidate);
  return kept;
}

}  // namespace pcl_symmetry
