#include "core/detection/plane_doubts.h"

#include <algorithm>

#include "core/detection/detection_rules.h"
#include "core/detection/standing_object.h"

namespace pcl_symmetry {

namespace {

/// Among the planes that are as likely as the likeliest, D decides.
/// \return null where there is none.
const SymmetryPlane* bestOf(const std::vector<SymmetryPlane>& planes) {
  double most = 0.0;
  for (const SymmetryPlane& plane : planes) most = std::max(most, plane.confidence);
  const auto best = std::max_element(planes.begin(), planes.end(), [&](const SymmetryPlane& a, const SymmetryPlane& b) {
    const bool a_likely = a.confidence >= most - kDetection.decide.as_likely,
               b_likely = b.confidence >= most - kDetection.decide.as_likely;
    return a_likely != b_likely ? b_likely : a.score < b.score;
  });
  return best == planes.end() ? nullptr : &*best;
}

}  // namespace

bool explainsAll(const SymmetryPlane& plane, CloudKind kind) {
  return kKindRules.may_lack_piece[kind] && plane.kind == PlaneKind::Symmetry &&
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
  for (SymmetryPlane& plane : planes)
    if (&plane != best)
      multiplyOdds(plane, furtherOdds(kind, 1.0 - plane.seen), "another plane or axis is better", options);
}

void doubtSlantedPlanes(std::vector<SymmetryPlane>& planes, const std::vector<Eigen::Vector3d>& carrying_normals,
                        const DetectionOptions& options) {
  for (SymmetryPlane& plane : planes)
    if (isDecided(plane) && slants(plane, carrying_normals))
      multiplyOdds(plane, kDetection.decide.slanted_odds, "slants on what the object stands on", options);
}

}  // namespace pcl_symmetry
