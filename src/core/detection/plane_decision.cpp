#include "core/detection/plane_decision.h"

#include <algorithm>

#include "core/base/lists.h"
#include "core/base/statistics.h"
#include "core/detection/standing_object.h"

namespace pcl_symmetry {

namespace {

bool isLimit(const Reason& reason) {
  return !reason.odds;
}

double oddsOf(double confidence) {
  constexpr double least = 1e-9;  // keeps the odds of a probability of 1 finite
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

/// The plane of greatest D among those that are about as likely as the likeliest one.
/// \return null if there is no plane.
const SymmetryPlane* bestOf(const std::vector<SymmetryPlane>& planes) {
  double greatest = 0.0;
  for (const SymmetryPlane& plane : planes) greatest = std::max(greatest, plane.confidence);
  const auto best = std::max_element(planes.begin(), planes.end(), [&](const SymmetryPlane& a, const SymmetryPlane& b) {
    const bool a_likely = a.confidence >= greatest - kDetection.decide.as_likely,
               b_likely = b.confidence >= greatest - kDetection.decide.as_likely;
    return a_likely != b_likely ? b_likely : a.score < b.score;
  });
  return best == planes.end() ? nullptr : &*best;
}

/// The order of the results: symmetries, then possible ones, both by decreasing confidence, then others by decreasing
/// support. The sort is stable.
bool isBetter(const SymmetryPlane& a, const SymmetryPlane& b) {
  const auto rank = [](const SymmetryPlane& plane) {
    return plane.kind == PlaneKind::Symmetry ? 0 : plane.kind == PlaneKind::Possible ? 1 : 2;
  };
  if (rank(a) != rank(b)) return rank(a) < rank(b);
  return isDecided(a) ? a.confidence > b.confidence : a.support > b.support;
}

}  // namespace

void setConfidence(SymmetryPlane& plane, double confidence, const char* evidence, const DetectionOptions& options) {
  std::vector<Reason>& reasons = plane.reasons;
  eraseIf(reasons, [](const Reason& reason) { return !isLimit(reason); });
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

bool explainsAll(const SymmetryPlane& plane, CloudKind kind) {
  return kind == CloudKind::Surface && plane.kind == PlaneKind::Symmetry &&
         1.0 - plane.seen <= kDetection.decide.nothing_missing;
}

void doubtMissingPieces(std::vector<SymmetryPlane>& planes, CloudKind kind, const DetectionOptions& options) {
  if (std::none_of(planes.begin(), planes.end(), [&](const SymmetryPlane& plane) { return explainsAll(plane, kind); }))
    return;
  for (SymmetryPlane& plane : planes)
    if (1.0 - plane.seen > kDetection.decide.piece_missing)
      multiplyOdds(plane, kDetection.decide.odds_of_a_piece, "needs a missing piece, but another plane explains all",
                   options);
}

void doubtFurtherPlanes(std::vector<SymmetryPlane>& planes, bool has_family, CloudKind kind,
                        const DetectionOptions& options) {
  const SymmetryPlane* const best = has_family ? nullptr : bestOf(planes);
  const char* const rule = has_family ? "there is an axis or a center, which explains more than a plane"
                                      : "another plane is likelier, or as likely with a greater score";
  for (SymmetryPlane& plane : planes)
    if (&plane != best) multiplyOdds(plane, furtherOdds(kind, 1.0 - plane.seen), rule, options);
}

void doubtSlantedPlanes(std::vector<SymmetryPlane>& planes, const std::vector<Eigen::Vector3d>& support_normals,
                        const DetectionOptions& options) {
  for (SymmetryPlane& plane : planes)
    if (isDecided(plane) && isSlanted(plane, support_normals))
      multiplyOdds(plane, kDetection.decide.slanted_odds, "slants on what the object stands on", options);
}

std::vector<SymmetryPlane> sortPlanes(std::vector<SymmetryPlane> planes, const DetectionOptions& options) {
  if (!options.approximate) eraseIf(planes, [](const SymmetryPlane& p) { return !isDecided(p); });
  std::stable_sort(planes.begin(), planes.end(), isBetter);
  return planes;
}

}  // namespace pcl_symmetry
