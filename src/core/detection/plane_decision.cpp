#include "core/detection/plane_decision.h"

#include <algorithm>
#include <utility>

#include "core/detection/standing_object.h"

namespace pcl_symmetry {

namespace {

// Shares of the surface: less is missing by chance, and more is a piece; and the odds that a cloud lacks a piece
// although a plane explains all of it. chosen: cuts along a plane of symmetry are rare; at one, the plane across an
// open cup is as good as its others, at a hundredth, cut prisms lose planes.
constexpr double kNothingMissing = 0.01, kPieceMissing = 0.03, kOddsOfAPiece = 0.2;
// Odds of a plane that slants over those of one that does not, where both have the same confidence. chosen: one in ten.
// Of the planes called in scenes of fold 0, 7 of 228 right ones slant and 27 of 85 wrong ones: too few for a fit.
constexpr double kSlantedOdds = 0.1;
// Share of the samples of a scan that a plane moves to where something is known, below which its confidence falls: a
// table lies on itself, and what stands on it lands below, where nothing was seen. chosen: no right plane of 100
// labelled objects in frames of a Kinect is lost, and a table with a carton and bottles is no symmetry. Of 160 planes
// of virtual scans three are lost.
constexpr double kLeastTold = 0.1;
// Share of the diameter: a sensor that resolves less decides at this. measured: of 100 labelled objects in frames of a
// Kinect 90 are decided right at 2 %, 94 at 2.5 % and 95 at 3 %, with four, three and three wrong.
constexpr double kCoarsestTolerance = 0.03;
// Share of the points that a plane leaves in place if it says nothing. chosen: half, as a sheet may be noisy; a box as
// thin as two tolerances keeps its plane at any value.
constexpr double kStillShare = 0.5;
constexpr double kLookErrors =
    2.0;  // standard errors of a quick look. chosen: with one, symmetries of few points are lost

double withOdds(double confidence, double factor) {
  return factor * confidence / (1.0 - confidence + factor * confidence);
}

}  // namespace

SymmetryPlane PlaneDecision::decide(PlaneRecord record) const {
  SymmetryPlane plane(cloud_.toInput(record.plane));
  const PlaneEvidence& evidence = record.evidence;
  const ShareInterval interval = shareInterval(evidence);
  plane.score = evidence.score;
  plane.support = seenSupport(evidence);
  plane.share = evidence.share;
  plane.share_low = interval.low;
  plane.share_high = interval.high;
  plane.deviation = record.deviation * cloud_.scale;
  plane.seen = record.seen;
  plane.point_support = std::move(record.point_support);
  plane.iterations = record.iterations;
  plane.converged = record.converged;
  plane.residual = record.residual * cloud_.scale;
  decideBy(planeConfidence(evidence) * std::min(1.0, record.told / kLeastTold), plane);
  return plane;
}

void PlaneDecision::decideBy(double confidence, SymmetryPlane& plane) const {
  plane.confidence = confidence;
  plane.kind = kindOf(plane, confidence);
}

PlaneKind PlaneDecision::kindOf(const ReflectionPlane& plane, double confidence) const {
  // What moves nothing says nothing: a sheet is mapped onto itself by its own plane, whatever it is a part of.
  const auto saysNothing = [&] {
    if (measure_.thinness() == Thinness::Solid) return false;
    return measure_.thinness() == Thinness::Line || measure_.movedShare(cloud_.toNormalized(plane)) < 1.0 - kStillShare;
  };
  if (confidence >= options_.min_confidence && isResolved() && !saysNothing()) return PlaneKind::Symmetry;
  return confidence >= options_.min_possible ? PlaneKind::Possible : PlaneKind::Approximate;
}

bool PlaneDecision::isResolved() const {
  return measure_.tolerance() >= std::min(measure_.resolution(), kCoarsestTolerance * cloud_.extent);
}

bool PlaneDecision::explainsAll(const SymmetryPlane& plane) const {
  return cloud_.rules().may_lack_piece && plane.kind == PlaneKind::Symmetry && 1.0 - plane.seen <= kNothingMissing;
}

bool PlaneDecision::isHopeless(const Candidate& candidate) const {
  if (!cloud_.rules().may_lack_piece || candidate.merit >= kSymmetricMerit) return false;
  const PlaneMeasure::QuickShare quick = measure_.quickShare(candidate);
  return quick.share + kLookErrors * quick.error < kSymmetricMerit;
}

void PlaneDecision::preferWhole(std::vector<SymmetryPlane>& planes) const {
  if (std::none_of(planes.begin(), planes.end(), [&](const SymmetryPlane& plane) { return explainsAll(plane); }))
    return;
  for (SymmetryPlane& plane : planes) {
    if (1.0 - plane.seen <= kPieceMissing) continue;
    const double odds = kOddsOfAPiece * plane.confidence;
    decideBy(odds / (odds + 1.0 - plane.confidence), plane);
  }
}

void PlaneDecision::preferBest(std::vector<SymmetryPlane>& planes, bool has_family) const {
  const auto best = std::max_element(planes.begin(), planes.end(), [](const SymmetryPlane& a, const SymmetryPlane& b) {
    return a.confidence < b.confidence;
  });
  for (auto plane = planes.begin(); plane != planes.end(); ++plane)
    if (plane != best || has_family)
      decideBy(furtherConfidence(plane->confidence, cloud_.kind(), 1.0 - plane->seen), *plane);
}

void PlaneDecision::doubtSlanted(std::vector<SymmetryPlane>& planes) const {
  if (!cloud_.seen() || cloud_.seen()->supports().empty()) return;
  const std::vector<Eigen::Vector3d> normals = carryingNormals(cloud_.points, *cloud_.seen());
  for (SymmetryPlane& plane : planes)
    if (isDecided(plane) && slants(plane, normals)) decideBy(withOdds(plane.confidence, kSlantedOdds), plane);
  if (!options_.approximate)
    planes.erase(std::remove_if(planes.begin(), planes.end(), [](const SymmetryPlane& p) { return !isDecided(p); }),
                 planes.end());
  std::stable_sort(planes.begin(), planes.end(), isBetter);
}

int rankOf(const SymmetryPlane& plane) {
  return plane.kind == PlaneKind::Symmetry ? 0 : plane.kind == PlaneKind::Possible ? 1 : 2;
}

bool isBetter(const SymmetryPlane& a, const SymmetryPlane& b) {
  const int rank = rankOf(a);
  if (rank != rankOf(b)) return rank < rankOf(b);
  if (rank < 2 && a.confidence != b.confidence) return a.confidence > b.confidence;
  return a.support > b.support;
}

}  // namespace pcl_symmetry
