#include "core/detection/plane_judge.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/detection/candidates.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

// A scan yields many candidates and few planes: each is judged by one sample in this many. chosen: fewer samples make
// the confidence noisy, more cost time.
constexpr int kScanShare = 4;
// Iterations of a plane of a part. chosen: as many as of a candidate in its second stage.
constexpr int kPartIterations = 6;

}  // namespace

PlaneJudge::PlaneJudge(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options)
    : cloud_(cloud), fit_(fit), options_(options) {}

std::vector<SymmetryPlane> PlaneJudge::judge(const std::vector<Candidate>& candidates) const {
  const Eigen::Index num_points = cloud_.points.cols();
  const std::vector<int> samples =
      cloud_.isScan() ? drawSamples(num_points, options_.num_refine_samples / kScanShare, options_.seed)
                      : allOf(num_points);
  std::vector<SymmetryPlane> planes(candidates.size());
  parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
    const Candidate& candidate = candidates[i];
    // The last stage may have matched these very samples.
    const bool has_matches = candidate.last.last.closest.size() == samples.size();
    const IspStep step = has_matches ? candidate.last.last : fit_.matches(candidate.plane, samples);
    planes[i] = judged(candidate.plane, fit_.shares(candidate.plane, samples, step));
    planes[i].iterations = candidate.iterations;
    planes[i].converged = candidate.last.converged;
    planes[i].residual = step.residual * cloud_.scale;
  });
  return planes;
}

SymmetryPlane PlaneJudge::judged(const ReflectionPlane& plane, const PlaneShares& shares) const {
  SymmetryPlane answer(cloud_.toInput(plane));
  answer.point_support = shares.point_support;
  answer.score = cloud_.score(answer);
  const PlaneEvidence evidence = fit_.evidence(shares.support, shares.conflict, answer.score);
  answer.support = seenSupport(evidence);
  answer.seen = std::min(1.0, shares.support + shares.conflict);
  answer.confidence = planeConfidence(evidence);
  answer.kind = answer.confidence >= options_.min_confidence                    ? PlaneKind::Symmetry
                : cloud_.isScan() && answer.confidence >= options_.min_possible ? PlaneKind::Possible
                                                                                : PlaneKind::Approximate;
  return answer;
}

SymmetryAxis PlaneJudge::judgeFamily(const std::vector<ReflectionPlane>& planes,
                                     const std::vector<int>& samples) const {
  const double count = static_cast<double>(planes.size());
  double support = 0.0, conflict = 0.0, score = 0.0;
  for (const ReflectionPlane& plane : planes) {
    const PlaneShares shares = fit_.shares(plane, samples);
    support += shares.support / count;
    conflict += shares.conflict / count;
    score += cloud_.score(cloud_.toInput(plane)) / count;
  }
  const PlaneEvidence evidence = fit_.evidence(support, conflict, score);
  SymmetryAxis family{};
  family.confidence = planeConfidence(evidence);
  family.score = score;
  family.support = seenSupport(evidence);
  return family;
}

std::vector<SymmetryPlane> PlaneJudge::findParts(const std::vector<SymmetryPlane>& known) const {
  IspOptions isp;
  isp.update = options_.update;
  isp.sigma = cloud_.sigma;
  isp.final_sigma = cloud_.final_sigma;
  isp.max_iterations = kPartIterations;
  const auto support = [this](const ReflectionPlane& plane, const std::vector<int>& samples) {
    return std::min(1.0, fit_.shares(plane, samples).support / cloud_.baseline);
  };
  const std::vector<int> all = allOf(cloud_.points.cols());
  std::vector<SymmetryPlane> planes;
  for (const SymmetricPart& part : findSymmetricParts(cloud_.surface, isp, support)) {
    const auto normalized = [this](const SymmetryPlane& plane) { return cloud_.toNormalized(plane); };
    if (basinTolerance().anySame(known, part.plane, normalized)) continue;
    const IspStep step = fit_.matches(part.plane, all);
    SymmetryPlane plane = judged(part.plane, fit_.shares(part.plane, all, step));
    if (plane.kind == PlaneKind::Symmetry) continue;  // one of a family, which is known as its axis or center
    plane.kind = PlaneKind::Local;
    plane.iterations = part.iterations;
    plane.residual = step.residual * cloud_.scale;
    planes.push_back(std::move(plane));
  }
  return planes;
}

}  // namespace pcl_symmetry
