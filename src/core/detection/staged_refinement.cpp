#include "core/detection/staged_refinement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/detection/plane_lattice.h"
#include "core/geometry/cloud_extent.h"

namespace pcl_symmetry {

std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options) {
  std::vector<Candidate> candidates;
  for (const LocalMaximum& maximum : findLocalMaxima(map, options.expert.maxima, options.num_threads)) {
    if (static_cast<int>(candidates.size()) >= options.expert.max_candidates) break;
    const ReflectionPlane plane = cloud.toNormalized(maximum.plane);
    if (kSameMaximum.anySame(candidates, plane, &Candidate::plane)) continue;
    candidates.push_back({plane, true});
  }
  for (const ReflectionPlane& plane : principalPlanes(cloud.principal_axes)) candidates.push_back({plane, false});
  return candidates;
}

StagedRefinement::StagedRefinement(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options)
    : cloud_(cloud), fit_(fit), options_(options) {}

std::vector<Candidate> StagedRefinement::coarse(std::vector<Candidate> candidates, const PlaneGrid& grid) const {
  const double narrow =
      std::clamp(cloud_.final_sigma, kDetection.stages.narrowest_coarsely * cloud_.sigma, cloud_.sigma);
  const std::vector<Candidate> moved = refined(
      candidates, stage(kDetection.stages.first_samples, cloud_.sigma, narrow, kDetection.stages.coarse_iterations));
  return distinct(withinCells(moved, candidates, grid), -1.0, kDetection.stages.kept_coarsely);
}

std::vector<Candidate> StagedRefinement::close(std::vector<Candidate> candidates) const {
  const auto isSymmetry = [](const Candidate& candidate) {
    return candidate.merit >= kDetection.stages.symmetric_merit;
  };
  const bool all = kKindRules.keeps_unlikely[cloud_.kind()] || options_.approximate;
  const auto likely =
      all ? candidates.end()
          : std::stable_partition(candidates.begin(), candidates.end(), [](const Candidate& candidate) {
              return candidate.merit >= kDetection.stages.symmetric_merit - kDetection.stages.coarse_slack;
            });
  std::vector<Candidate> found = refined({candidates.begin(), likely}, closeStage());
  // Once a whole cloud has a symmetry, candidates far below it are dropped.
  if (!all && std::any_of(found.begin(), found.end(), isSymmetry)) return distinct(std::move(found), -1.0, 0);
  for (Candidate& other : refined({likely, candidates.end()}, closeStage())) found.push_back(std::move(other));
  const bool is_whole = std::any_of(found.begin(), found.end(), isSymmetry);
  return distinct(std::move(found), -1.0, all || !is_whole ? kDetection.stages.kept_closely : 0);
}

std::vector<Candidate> StagedRefinement::closeSymmetries(std::vector<Candidate> candidates) const {
  return distinct(refined(std::move(candidates), closeStage()),
                  kDetection.stages.symmetric_merit - kDetection.stages.close_slack, kDetection.stages.kept_closely);
}

std::vector<Candidate> StagedRefinement::full(std::vector<Candidate> candidates) const {
  return refined(std::move(candidates), fullStage());
}

std::vector<char> StagedRefinement::climb(std::vector<Candidate>& candidates) const {
  if (!kKindRules.climbs[cloud_.kind()]) return std::vector<char>(candidates.size(), false);
  return fit_.climb(candidates, fullStage());
}

RefinementStage StagedRefinement::fullStage() const {
  RefinementStage full = stage(options_.expert.num_refine_samples / kKindRules.full_stride[cloud_.kind()],
                               cloud_.final_sigma, cloud_.final_sigma, kDetection.stages.full_iterations);
  full.climbs = true;
  return full;
}

RefinementStage StagedRefinement::closeStage() const {
  return stage(std::min(kDetection.stages.close_sample_factor * kDetection.stages.first_samples,
                        options_.expert.num_refine_samples),
               std::clamp(cloud_.final_sigma, kDetection.stages.narrowest_coarsely * cloud_.sigma, cloud_.sigma),
               cloud_.final_sigma, kDetection.stages.close_iterations);
}

RefinementStage StagedRefinement::stage(int num_samples, double sigma, double final_sigma, int max_iterations) const {
  const CloudKind kind = cloud_.kind();
  RefinementStage stage;
  stage.num_samples = std::max(1, num_samples);
  stage.num_rough_samples =
      std::clamp(options_.expert.num_refine_samples / kKindRules.rough_stride[kind], 1, stage.num_samples);
  stage.min_merit = kKindRules.settled_merit[kind];
  stage.undo_slides = kKindRules.slides[kind] && final_sigma == sigma;
  // On the way to narrow weights, point-to-plane steps would slide a scan along its flat pieces.
  const bool slides = kKindRules.slides[kind] && num_samples > kDetection.stages.first_samples && final_sigma < sigma;
  if (slides) stage.isp.update = IspUpdate::PointToPoint;
  stage.isp.sigma = sigma;
  stage.isp.final_sigma = final_sigma;
  stage.isp.max_iterations = max_iterations;
  stage.rough_isp = stage.isp;
  stage.rough_isp.max_iterations = std::min(stage.isp.max_iterations, kDetection.stages.rough_iterations);
  stage.isp.error_share = kDetection.stages.settled_error_share;
  return stage;
}

std::vector<Candidate> StagedRefinement::refined(std::vector<Candidate> candidates,
                                                 const RefinementStage& stage) const {
  fit_.refine(candidates, stage);
  return candidates;
}

/// The candidates that stayed near the cell they came from. Departure from the paper, which drops all that leave their
/// cell: a map of few samples has its maxima up to one cell off, hence kDetection.stages.max_drift; and those that map
/// more of the shape than all that stayed are not lost.
std::vector<Candidate> StagedRefinement::withinCells(const std::vector<Candidate>& candidates,
                                                     const std::vector<Candidate>& starts,
                                                     const PlaneGrid& grid) const {
  const double reach = 0.5 + kDetection.stages.max_drift;
  const PlaneTolerance cell{std::sqrt(2.0) * reach * std::max(grid.thetaStep(), grid.phiStep()),
                            reach * grid.radiusStep() / cloud_.scale};
  std::vector<Candidate> kept, left;
  double best = 0.0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool stays = !candidates[i].from_map || cell.same(starts[i].plane, candidates[i].plane);
    (stays ? kept : left).push_back(candidates[i]);
    if (stays) best = std::max(best, candidates[i].merit);
  }
  for (const Candidate& candidate : left)
    if (kKindRules.climbs[cloud_.kind()] && candidate.merit > best) kept.push_back(candidate);
  return kept;
}

std::vector<Candidate> StagedRefinement::distinct(std::vector<Candidate> candidates, double min_merit,
                                                  std::size_t most) const {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.merit > b.merit; });
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    if (candidate.merit < min_merit) break;
    if (candidate.merit < kDetection.stages.symmetric_merit - kDetection.stages.close_slack && kept.size() >= most)
      break;
    if (!kSamePlane.anySame(kept, candidate.plane, &Candidate::plane)) kept.push_back(std::move(candidate));
  }
  return kept;
}

std::vector<Candidate> GroupClosure::next(const std::vector<SymmetryPlane>& planes) {
  std::vector<ReflectionPlane> symmetries;
  for (const SymmetryPlane& plane : planes)
    if (plane.kind == PlaneKind::Symmetry) symmetries.push_back(cloud_.toNormalized(plane));
  std::vector<Candidate> found;
  if (!kKindRules.completes_groups[cloud_.kind()]) return found;
  tried_.insert(tried_.end(), symmetries.begin(), symmetries.end());
  const auto add = [&](const ReflectionPlane& plane) {
    if (kSamePlane.anySame(tried_, plane)) return;
    tried_.push_back(plane);
    found.push_back({plane, false});
  };
  // The planes of a regular polygon, from those of them that are known.
  if (const std::optional<PlaneLattice> lattice = findLattice(symmetries))
    for (int k = 0; k < lattice->fold; ++k) add(lattice->plane(k));
  if (symmetries.size() > kDetection.closure.max_closed) return found;
  for (const ReflectionPlane& plane : symmetries) {
    for (const ReflectionPlane& across : symmetries) {
      const Eigen::Vector3d normal = plane.normal() - 2.0 * plane.normal().dot(across.normal()) * across.normal();
      const ReflectionPlane image(normal, normal.dot(across.reflect(plane.offset() * plane.normal())));
      add(image);
    }
  }
  return found;
}

}  // namespace pcl_symmetry
