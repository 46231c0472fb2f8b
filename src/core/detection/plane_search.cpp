#include "core/detection/plane_search.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"
#include "core/detection/plane_decision.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

MeasuredPlane PlaneSearch::decide(MeasuredPlane measured, const ReflectionPlane& plane) const {
  SymmetryPlane& result = measured.plane;
  for (const char* rule : measure.limits().rulesAgainst(plane, cloud.points)) limitToPossible(result, rule);
  constexpr KindRule<const char*> kRule{
      "how much of the surface the plane maps onto it, and how finely the points show it",
      "how much of the surface the plane maps onto it, and how much was seen",
      "how well each half of the points predicts the other; few points leave it open"};
  setConfidence(result, planeConfidence(measured.evidence), kRule[cloud.kind()], options);
  const double informative = std::min(1.0, measured.informative / kDetection.decide.min_informative);
  if (informative < 1.0)
    changeConfidence(result, result.confidence * informative, "few points move and land where the scanner saw",
                     options);
  return measured;
}

bool PlaneSearch::isHopeless(const Candidate& candidate) const {
  if (!cloud.isSurface() || candidate.merit >= kDetection.stages.symmetric_merit) return false;
  return measure.greatestShare(candidate) < kDetection.decide.hopeful_share;
}

std::vector<MeasuredPlane> PlaneSearch::judge(const std::vector<Candidate>& candidates) const {
  std::vector<MeasuredPlane> judged(candidates.size());
  rejudge(candidates, std::vector<char>(candidates.size(), true), judged);
  return judged;
}

void PlaneSearch::rejudge(const std::vector<Candidate>& candidates, const std::vector<char>& chosen,
                          std::vector<MeasuredPlane>& judged) const {
  const std::vector<int> samples = measure.samples();
  parallelBlocks(candidates.size(), options.num_threads, [&](std::size_t i) {
    if (chosen[i]) judged[i] = decide(measure.measureCandidate(candidates[i], samples), candidates[i].plane);
  });
}

MeasuredPlane PlaneSearch::judge(const ReflectionPlane& plane, const std::vector<int>& samples) const {
  return decide(measure.measurePlane(plane, samples), plane);
}

JudgedFamily PlaneSearch::judgeFamily(const std::vector<ReflectionPlane>& planes,
                                      const std::vector<int>& samples) const {
  const double count = static_cast<double>(planes.size());
  const bool is_scan = cloud.isScan();
  JudgedFamily family;
  PlaneEvidence together;
  together.share = together.double_share = together.stiffness = 0.0;
  double informative = 0.0, best_score = 0.0;
  for (const ReflectionPlane& plane : planes) {
    const PlaneEvidence one = measure.measurePlane(plane, samples, is_scan ? measure.tolerance() : 0.0).evidence;
    together.support += one.support / count;
    together.conflict += one.conflict / count;
    const double part = (1.0 - one.unknown) / count;
    informative += part;
    together.share += part * one.share;
    together.double_share += part * one.double_share;
    together.stiffness += one.stiffness / count;
    best_score = std::max(best_score, one.score);
    family.score += one.score / count;
    family.min_confidence = std::min(family.min_confidence, planeConfidence(one));
  }
  // A scan shows some planes of a family better than others, and hidden parts lower D: the most visible plane
  // represents the family.
  constexpr double least = 1e-3;  // avoids a division by 0
  PlaneEvidence mean = measure.evidenceOf(together.support, together.conflict, is_scan ? best_score : family.score);
  mean.share = together.share / std::max(least, informative);
  mean.double_share = together.double_share / std::max(least, informative);
  mean.stiffness = together.stiffness;
  mean.unknown = 1.0 - informative;
  family.confidence = planeConfidence(mean);
  family.support = seenSupport(mean);
  return family;
}

std::vector<SymmetryPlane> PlaneSearch::refineAndJudge(std::vector<Candidate> candidates) const {
  candidates = fit.refineFully(std::move(candidates));
  std::vector<MeasuredPlane> measured = judge(candidates);
  std::vector<char> may_climb;
  for (const MeasuredPlane& one : measured)
    may_climb.push_back(one.plane.confidence >= kDetection.fit.climbing_confidence);
  rejudge(candidates, fit.climb(candidates, may_climb), measured);
  std::vector<SymmetryPlane> planes;
  for (MeasuredPlane& one : measured) planes.push_back(std::move(one.plane));
  return planes;
}

std::vector<SymmetryPlane> decidePlanesNear(const std::vector<ReflectionPlane>& starts, const PlaneInput& input,
                                            const DetectionOptions& options) {
  if (!whyUnanswerable(input.points).empty()) return {};
  const std::optional<std::vector<int>> subset = drawSubset(input.points, options);
  const DistinctPoints distinct(subset ? pointsAt(input.points, *subset) : Points(input.points));
  const GaussianEdt edt(distinct.points, options.edtOptions());
  const NormalizedCloud cloud(distinct.points, edt, nullptr, input.visibility, options.num_threads);
  const PlaneSearch search(cloud, cloud.points, options);
  std::vector<Candidate> candidates;
  for (const ReflectionPlane& start : starts) candidates.push_back({cloud.toNormalized(start)});
  return search.refineAndJudge(search.fit.refineClosely(std::move(candidates)));
}

}  // namespace pcl_symmetry
