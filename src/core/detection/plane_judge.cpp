#include "core/detection/plane_judge.h"

#include <algorithm>
#include <utility>

#include "core/base/parallel.h"

namespace pcl_symmetry {

std::vector<SymmetryPlane> PlaneJudge::judge(const std::vector<Candidate>& candidates) const {
  std::vector<SymmetryPlane> planes;
  for (JudgedPlane& judged : judgeWithEvidence(candidates)) planes.push_back(std::move(judged.plane));
  return planes;
}

std::vector<JudgedPlane> PlaneJudge::judgeWithEvidence(const std::vector<Candidate>& candidates) const {
  const std::vector<int> samples = measure.samples();
  std::vector<JudgedPlane> planes(candidates.size());
  parallelBlocks(candidates.size(), options_.num_threads, [&](std::size_t i) {
    PlaneRecord record = measure.of(candidates[i], samples);
    planes[i].evidence = record.evidence;
    planes[i].plane = decision.decide(std::move(record));
  });
  return planes;
}

JudgedFamily PlaneJudge::judgeFamily(const std::vector<ReflectionPlane>& planes,
                                     const std::vector<int>& samples) const {
  const double count = static_cast<double>(planes.size());
  const bool is_scan = cloud_.seen() != nullptr;
  JudgedFamily family;
  PlaneEvidence together;
  together.share = together.double_share = together.hold = 0.0;
  double telling = 0.0, best_score = 0.0;
  for (const ReflectionPlane& plane : planes) {
    const PlaneEvidence one = measure.of(plane, samples, is_scan ? measure.tolerance() : 0.0).evidence;
    together.support += one.support / count;
    together.conflict += one.conflict / count;
    const double told = (1.0 - one.unknown) / count;
    telling += told;
    together.share += told * one.share;
    together.double_share += told * one.double_share;
    together.hold += one.hold / count;
    best_score = std::max(best_score, one.score);
    family.score += one.score / count;
    family.least_confidence = std::min(family.least_confidence, planeConfidence(one));
  }
  // Planes of a family say as much as the scan shows of them, and D falls with what it does not show: the plane that
  // is shown best represents it.
  constexpr double kLeastTelling = 1e-3;  // avoids a division by 0
  PlaneEvidence all = measure.evidenceOf(together.support, together.conflict, is_scan ? best_score : family.score);
  all.share = together.share / std::max(kLeastTelling, telling);
  all.double_share = together.double_share / std::max(kLeastTelling, telling);
  all.hold = together.hold;
  all.unknown = 1.0 - telling;
  family.confidence = planeConfidence(all);
  family.support = seenSupport(all);
  return family;
}

}  // namespace pcl_symmetry
