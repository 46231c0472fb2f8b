#include "core/detection/staged_refinement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/lists.h"

namespace pcl_symmetry {

std::vector<Candidate> StagedRefinement::refineCoarsely(std::vector<Candidate> candidates,
                                                        const PlaneGrid& grid) const {
  const std::vector<Candidate> moved = fit.refine(
      candidates,
      stage(kDetection.stages.first_samples, cloud.sigma, coarseSigma(), kDetection.stages.coarse_iterations));
  return distinct(withinCells(moved, candidates, grid), kDetection.stages.kept_coarsely);
}

std::vector<Candidate> StagedRefinement::refineClosely(std::vector<Candidate> candidates) const {
  const auto isSymmetry = [](const Candidate& candidate) {
    return candidate.merit >= kDetection.stages.symmetric_merit;
  };
  const bool keeps_all = cloud.isScan() || options.approximate;
  const auto likely =
      keeps_all ? candidates.end()
                : std::stable_partition(candidates.begin(), candidates.end(), [](const Candidate& candidate) {
                    return candidate.merit >= kDetection.stages.symmetric_merit - kDetection.stages.coarse_slack;
                  });
  std::vector<Candidate> found = fit.refine({candidates.begin(), likely}, closeStage());
  // Once a whole cloud has a symmetry, candidates of much less merit are dropped.
  if (!keeps_all && std::any_of(found.begin(), found.end(), isSymmetry)) return distinct(std::move(found), 0);
  append(found, fit.refine({likely, candidates.end()}, closeStage()));
  const bool is_whole = std::any_of(found.begin(), found.end(), isSymmetry);
  return distinct(std::move(found), keeps_all || !is_whole ? kDetection.stages.kept_closely : 0);
}

std::vector<Candidate> StagedRefinement::refineSymmetries(std::vector<Candidate> candidates) const {
  return distinct(fit.refine(std::move(candidates), closeStage()), kDetection.stages.kept_closely,
                  kDetection.stages.symmetric_merit - kDetection.stages.close_slack);
}

std::vector<Candidate> StagedRefinement::refineFully(std::vector<Candidate> candidates) const {
  return fit.refine(std::move(candidates), fullStage());
}

std::vector<char> StagedRefinement::climb(std::vector<Candidate>& candidates,
                                          const std::vector<char>& may_climb) const {
  if (cloud.isScan()) return std::vector<char>(candidates.size(), false);
  return fit.climb(candidates, fullStage(), may_climb);
}

double StagedRefinement::coarseSigma() const {
  return std::clamp(cloud.final_sigma, kDetection.stages.narrowest_coarsely * cloud.sigma, cloud.sigma);
}

RefinementStage StagedRefinement::fullStage() const {
  RefinementStage full = stage(options.expert.num_refine_samples / kKindRules.full_stride[cloud.kind()],
                               cloud.final_sigma, cloud.final_sigma, kDetection.stages.full_iterations);
  full.climbs = true;
  return full;
}

RefinementStage StagedRefinement::closeStage() const {
  RefinementStage close = stage(std::min(kDetection.stages.close_sample_factor * kDetection.stages.first_samples,
                                         options.expert.num_refine_samples),
                                coarseSigma(), cloud.final_sigma, kDetection.stages.close_iterations);
  // On the way to narrow weights, point-to-plane steps would slide a scan along its flat pieces.
  if (cloud.isScan() && close.isp.final_sigma < close.isp.sigma)
    close.isp.update = close.rough_isp.update = IspUpdate::PointToPoint;
  return close;
}

RefinementStage StagedRefinement::stage(int num_samples, double sigma, double final_sigma, int max_iterations) const {
  const CloudKind kind = cloud.kind();
  RefinementStage stage;
  stage.num_samples = std::max(1, num_samples);
  stage.num_rough_samples =
      std::clamp(options.expert.num_refine_samples / kKindRules.rough_stride[kind], 1, stage.num_samples);
  stage.min_merit = kKindRules.settled_merit[kind];
  // For sparse points, the weights have their least width from the first stage on.
  stage.undo_slides = kind == CloudKind::Scan && final_sigma == sigma;
  stage.isp.sigma = sigma;
  stage.isp.final_sigma = final_sigma;
  stage.isp.max_iterations = max_iterations;
  stage.rough_isp = stage.isp;
  stage.rough_isp.max_iterations = std::min(stage.isp.max_iterations, kDetection.stages.rough_iterations);
  stage.isp.error_share = kDetection.stages.settled_error_share;
  return stage;
}

/// The candidates that stayed near the cell they came from. Departure from the paper: it drops all candidates that
/// leave their cell. Here maxima of a map of few samples are up to one cell off, hence kDetection.stages.max_drift, and
/// candidates that map more of the shape than all that stayed are kept.
std::vector<Candidate> StagedRefinement::withinCells(const std::vector<Candidate>& candidates,
                                                     const std::vector<Candidate>& starts,
                                                     const PlaneGrid& grid) const {
  const double reach = 0.5 + kDetection.stages.max_drift;
  const MergeTolerance cell{std::sqrt(2.0) * reach * std::max(grid.thetaStep(), grid.phiStep()),
                            reach * grid.radiusStep() / cloud.scale};
  std::vector<Candidate> kept, left;
  double best = 0.0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool stays = !candidates[i].from_map || cell.same(starts[i].plane, candidates[i].plane);
    (stays ? kept : left).push_back(candidates[i]);
    if (stays) best = std::max(best, candidates[i].merit);
  }
  for (const Candidate& candidate : left)
    if (!cloud.isScan() && candidate.merit > best) kept.push_back(candidate);
  return kept;
}

std::vector<Candidate> StagedRefinement::distinct(std::vector<Candidate> candidates, std::size_t max_count,
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

}  // namespace pcl_symmetry
