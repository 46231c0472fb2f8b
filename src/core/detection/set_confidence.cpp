#include "core/detection/set_confidence.h"

#include <algorithm>

#include "core/base/logistic.h"

namespace pcl_symmetry {

namespace {

bool isLimit(const Reason& reason) {
  return !reason.odds;
}

double oddsOf(double confidence) {
  constexpr double least = 1e-9;  // keeps the odds of certainty finite
  return std::max(least, confidence) / std::max(least, 1.0 - confidence);
}

void write(SymmetryPlane& plane, double confidence, const Reason& reason, const DetectionOptions& options) {
  plane.reasons.push_back(reason);
  plane.confidence = confidence;
  const bool is_limited = std::any_of(plane.reasons.begin(), plane.reasons.end(), isLimit);
  plane.kind = confidence >= options.min_confidence && !is_limited ? PlaneKind::Symmetry
               : confidence >= options.min_possible                ? PlaneKind::Possible
                                                                   : PlaneKind::Approximate;
}

}  // namespace

void setConfidence(SymmetryPlane& plane, double confidence, const char* evidence, const DetectionOptions& options) {
  std::vector<Reason>& reasons = plane.reasons;
  reasons.erase(std::remove_if(reasons.begin(), reasons.end(), [](const Reason& reason) { return !isLimit(reason); }),
                reasons.end());
  write(plane, confidence, {evidence, oddsOf(confidence)}, options);
}

void changeConfidence(SymmetryPlane& plane, double confidence, const char* rule, const DetectionOptions& options) {
  write(plane, confidence, {rule, oddsOf(confidence) / oddsOf(plane.confidence)}, options);
}

void multiplyOdds(SymmetryPlane& plane, double odds, const char* rule, const DetectionOptions& options) {
  if (odds != 1.0) write(plane, withOdds(plane.confidence, odds), {rule, odds}, options);
}

void limitToPossible(SymmetryPlane& plane, const char* rule) {
  plane.reasons.push_back({rule, std::nullopt});
  if (plane.kind == PlaneKind::Symmetry) plane.kind = PlaneKind::Possible;
}

void setLocal(SymmetryPlane& plane) {
  plane.kind = PlaneKind::Local;
}

}  // namespace pcl_symmetry
