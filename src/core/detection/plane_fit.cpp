#include "core/detection/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/statistics.h"
#include "core/evidence/point_density.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/cloud_extent.h"
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

  void refine(std::vector<Candidate>& candidates, const RefinementStage& stage) const override {
    const auto samples = std::make_shared<const std::vector<int>>(drawn(stage.num_samples)),
               fewer = std::make_shared<const std::vector<int>>(drawn(stage.num_rough_samples));
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      Candidate& candidate = candidates[i];
      const bool settles = candidate.iterations == 0 || candidate.merit >= stage.min_merit;
      candidate.samples = settles ? samples : fewer;
      const std::vector<int>& used = *candidate.samples;
      const ReflectionPlane start = candidate.plane;
      // The first steps have wide weights. Scans have many borders, at which walks end beside the closest point.
      const IspSurface& surface =
          candidate.iterations == 0 && kKindRules.shows_all[cloud_.kind()] ? cloud_.quick_surface : cloud_.surface;
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
        climbOne(candidate, used, *fewer);
    });
  }

  std::vector<char> climb(std::vector<Candidate>& candidates, const RefinementStage& stage,
                          const std::vector<char>& may_climb) const override {
    std::vector<char> moved(candidates.size(), false);
    const auto samples = std::make_shared<const std::vector<int>>(drawn(stage.num_samples));
    const std::vector<int> fewer = drawn(std::min(stage.num_rough_samples, kDetection.fit.climb_samples));
    parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
      Candidate& candidate = candidates[i];
      const bool is_at_rest = candidate.merit >= kDetection.stages.symmetric_merit;  // nothing pulls at it
      moved[i] = may_climb[i] && candidate.merit >= kDetection.fit.climbing_merit && !is_at_rest &&
                 climbOne(candidate, *samples, fewer);
      if (moved[i]) candidate.samples = samples;
    });
    return moved;
  }

  ReflectionPlane refined(const ReflectionPlane& plane, const std::vector<int>& samples,
                          int max_iterations) const override {
    IspOptions isp;
    isp.sigma = isp.final_sigma = cloud_.final_sigma;
    isp.max_iterations = max_iterations;
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

  /// Point-to-plane distances are uninformative along flat pieces, and a scan may have little else. The plane takes one
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

  /// Pairs whose true partners were cut off, or are hidden by noise, pull at a plane. It comes to rest beside the one
  /// that explains most of what is there, and climbs from there on the merit itself, along its three parameters.
  /// \param samples that the final merit is taken of.
  /// \param fewer samples by which the plane climbs.
  /// \return whether the plane moved.
  bool climbOne(Candidate& candidate, const std::vector<int>& samples, const std::vector<int>& fewer) const {
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

  void refine(std::vector<Candidate>& candidates, const RefinementStage& stage) const override {
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
  }

  ReflectionPlane refined(const ReflectionPlane& plane, const std::vector<int>& samples,
                          int max_iterations) const override {
    return density_.refine(pointsAt(cloud_.points, samples), plane, max_iterations).plane;
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
  SurfaceFit surface_;  ///< support of single points
  PointDensity density_;
};

}  // namespace

std::unique_ptr<PlaneFit> makePlaneFit(const NormalizedCloud& cloud, const DetectionOptions& options) {
  if (kKindRules.resolves_surface[cloud.kind()]) return std::make_unique<SurfaceFit>(cloud, options);
  return std::make_unique<VolumeFit>(cloud, options);
}

std::vector<float> surfaceSupport(const NormalizedCloud& cloud, const ReflectionPlane& plane,
                                  const DetectionOptions& options) {
  return SurfaceFit(cloud, options).shares(plane, allOf(cloud.points.cols())).points.seenSupport();
}

std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options) {
  std::vector<Candidate> candidates;
  for (const LocalMaximum& maximum : findLocalMaxima(map, options.expert.maxima, options.num_threads))
    candidates.push_back({cloud.toNormalized(maximum.plane), true});
  candidates = kSameMaximum.distinct(std::move(candidates), &Candidate::plane, options.expert.max_candidates);
  for (const ReflectionPlane& plane : principalPlanes(cloud.principal_axes)) candidates.push_back({plane});
  return candidates;
}

StagedRefinement::StagedRefinement(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options)
    : cloud_(cloud), fit_(fit), options_(options) {}

std::vector<Candidate> StagedRefinement::refineCoarsely(std::vector<Candidate> candidates,
                                                        const PlaneGrid& grid) const {
  const std::vector<Candidate> moved = refined(candidates, stage(kDetection.stages.first_samples, cloud_.sigma,
                                                                 coarseSigma(), kDetection.stages.coarse_iterations));
  return distinct(withinCells(moved, candidates, grid), -1.0, kDetection.stages.kept_coarsely);
}

std::vector<Candidate> StagedRefinement::refineClosely(std::vector<Candidate> candidates) const {
  const auto isSymmetry = [](const Candidate& candidate) {
    return candidate.merit >= kDetection.stages.symmetric_merit;
  };
  const bool keeps_all = !kKindRules.shows_all[cloud_.kind()] || options_.approximate;
  const auto likely =
      keeps_all ? candidates.end()
                : std::stable_partition(candidates.begin(), candidates.end(), [](const Candidate& candidate) {
                    return candidate.merit >= kDetection.stages.symmetric_merit - kDetection.stages.coarse_slack;
                  });
  std::vector<Candidate> found = refined({candidates.begin(), likely}, closeStage());
  // Once a whole cloud has a symmetry, candidates far below it are dropped.
  if (!keeps_all && std::any_of(found.begin(), found.end(), isSymmetry)) return distinct(std::move(found), -1.0, 0);
  append(found, refined({likely, candidates.end()}, closeStage()));
  const bool is_whole = std::any_of(found.begin(), found.end(), isSymmetry);
  return distinct(std::move(found), -1.0, keeps_all || !is_whole ? kDetection.stages.kept_closely : 0);
}

std::vector<Candidate> StagedRefinement::refineSymmetries(std::vector<Candidate> candidates) const {
  return distinct(refined(std::move(candidates), closeStage()),
                  kDetection.stages.symmetric_merit - kDetection.stages.close_slack, kDetection.stages.kept_closely);
}

std::vector<Candidate> StagedRefinement::refineFully(std::vector<Candidate> candidates) const {
  return refined(std::move(candidates), fullStage());
}

std::vector<char> StagedRefinement::climb(std::vector<Candidate>& candidates,
                                          const std::vector<char>& may_climb) const {
  if (!kKindRules.shows_all[cloud_.kind()]) return std::vector<char>(candidates.size(), false);
  return fit_.climb(candidates, fullStage(), may_climb);
}

double StagedRefinement::coarseSigma() const {
  return std::clamp(cloud_.final_sigma, kDetection.stages.narrowest_coarsely * cloud_.sigma, cloud_.sigma);
}

RefinementStage StagedRefinement::fullStage() const {
  RefinementStage full = stage(options_.expert.num_refine_samples / kKindRules.full_stride[cloud_.kind()],
                               cloud_.final_sigma, cloud_.final_sigma, kDetection.stages.full_iterations);
  full.climbs = true;
  return full;
}

RefinementStage StagedRefinement::closeStage() const {
  RefinementStage close = stage(std::min(kDetection.stages.close_sample_factor * kDetection.stages.first_samples,
                                         options_.expert.num_refine_samples),
                                coarseSigma(), cloud_.final_sigma, kDetection.stages.close_iterations);
  // On the way to narrow weights, point-to-plane steps would slide a scan along its flat pieces.
  if (!kKindRules.shows_all[cloud_.kind()] && close.isp.final_sigma < close.isp.sigma)
    close.isp.update = close.rough_isp.update = IspUpdate::PointToPoint;
  return close;
}

RefinementStage StagedRefinement::stage(int num_samples, double sigma, double final_sigma, int max_iterations) const {
  const CloudKind kind = cloud_.kind();
  RefinementStage stage;
  stage.num_samples = std::max(1, num_samples);
  stage.num_rough_samples =
      std::clamp(options_.expert.num_refine_samples / kKindRules.rough_stride[kind], 1, stage.num_samples);
  stage.min_merit = kKindRules.settled_merit[kind];
  // The weights of sparse points are at their narrowest from the first stage on.
  stage.undo_slides = !kKindRules.shows_all[kind] && final_sigma == sigma;
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
    if (kKindRules.shows_all[cloud_.kind()] && candidate.merit > best) kept.push_back(candidate);
  return kept;
}

std::vector<Candidate> StagedRefinement::distinct(std::vector<Candidate> candidates, double min_merit,
                                                  std::size_t most) const {
  sortFalling(candidates, &Candidate::merit);
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    if (candidate.merit < min_merit) break;
    if (candidate.merit < kDetection.stages.symmetric_merit - kDetection.stages.close_slack && kept.size() >= most)
      break;
    if (!kSamePlane.anySame(kept, candidate.plane, &Candidate::plane)) kept.push_back(std::move(candidate));
  }
  return kept;
}

std::vector<ReflectionPlane> planesOf(const std::vector<SymmetryPlane>& planes, std::initializer_list<PlaneKind> kinds,
                                      const NormalizedCloud& cloud) {
  std::vector<ReflectionPlane> found;
  for (const SymmetryPlane& plane : planes)
    if (std::find(kinds.begin(), kinds.end(), plane.kind) != kinds.end()) found.push_back(cloud.toNormalized(plane));
  return found;
}

std::vector<Candidate> impliedBy(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                 std::vector<ReflectionPlane>& tried) {
  const std::vector<ReflectionPlane> symmetries = planesOf(planes, {PlaneKind::Symmetry}, cloud);
  std::vector<Candidate> found;
  append(tried, symmetries);
  const auto add = [&](const ReflectionPlane& plane) {
    if (kSamePlane.anySame(tried, plane)) return;
    tried.push_back(plane);
    found.push_back({plane});
  };
  if (symmetries.size() > kDetection.closure.max_closed) return found;
  for (const ReflectionPlane& plane : symmetries) {
    for (const ReflectionPlane& across : symmetries) {
      const Eigen::Vector3d normal = plane.normal() - 2.0 * plane.normal().dot(across.normal()) * across.normal();
      add(ReflectionPlane(normal, normal.dot(across.reflect(plane.offset() * plane.normal()))));
    }
  }
  return found;
}

std::vector<Candidate> atRightAngles(const std::vector<SymmetryPlane>& planes,
                                     const std::vector<Eigen::Vector3d>& carrying_normals,
                                     const NormalizedCloud& cloud) {
  std::vector<Eigen::Vector3d> normals, tried;
  for (const SymmetryPlane& plane : planes)
    if (plane.kind == PlaneKind::Symmetry) normals.push_back(plane.normal());
  tried = normals;
  const std::size_t num_symmetries = normals.size();
  append(normals, carrying_normals);
  std::vector<Candidate> found;
  for (std::size_t i = 0; i < num_symmetries; ++i) {
    for (std::size_t k = i + 1; k < normals.size(); ++k) {
      if (std::abs(normals[i].dot(normals[k])) > std::sin(kDetection.decide.upright)) continue;
      const Eigen::Vector3d normal = normals[i].cross(normals[k]).normalized();
      const auto is_near = [&](const Eigen::Vector3d& other) {
        return std::abs(normal.dot(other)) > std::cos(kDetection.decide.upright);
      };
      if (std::any_of(tried.begin(), tried.end(), is_near)) continue;
      tried.push_back(normal);
      const Eigen::RowVectorXd along = normal.transpose() * cloud.points.cast<double>();
      const double low = along.minCoeff(), step = (along.maxCoeff() - low) / kDetection.closure.offsets_tried;
      for (int s = 0; s < kDetection.closure.offsets_tried; ++s)
        found.push_back({ReflectionPlane(normal, low + (s + 0.5) * step)});
    }
  }
  return found;
}

}  // namespace pcl_symmetry
