#include "core/evidence/plane_confidence.h"

#include <algorithm>
#include <cmath>

#include "core/evidence/confidence_fit.h"

namespace pcl_symmetry {

namespace {

// Share of the surface that is off, at which the log odds by the share are 0. derived: a symmetry has at most 0.03, an
// asymmetric shape at least 0.1; between them.
constexpr double kOffAtEvenOdds = 0.05;
// Error of that share: on clouds without noise, the same per spacing in radii, and on scans, whose parts that were not
// seen may differ. measured (apps/calibrate): 95 % of the symmetries of whole clouds have less than 0.005 + 0.1 h.
constexpr double kOffUnit = 0.005, kOffUnitPerSpacing = 0.1, kScanOffUnit = 0.01;
// Lost D on points without noise. chosen: at half, D of clean clouds decides alone; at twice, it hardly counts.
constexpr double kLostUnit = 0.002;

/// \return log odds by the share of the surface that is off, 0 near the limit of a symmetry.
double byShare(const PlaneEvidence& evidence, double unit) {
  return std::log((1.0 - evidence.share + unit) / (kOffAtEvenOdds + unit));
}

double surfaceLogOdds(const PlaneEvidence& evidence, const ConfidenceFit::Surface& fit) {
  return fit.intercept + fit.per_off * byShare(evidence, kOffUnit + kOffUnitPerSpacing * evidence.spacing) +
         fit.per_unknown * evidence.unknown;
}

double scanLogOdds(const PlaneEvidence& evidence, const ConfidenceFit::Scan& fit) {
  return fit.intercept + fit.per_off * byShare(evidence, kScanOffUnit) + fit.per_lost_score * (1.0 - evidence.score);
}

double volumeLogOdds(const PlaneEvidence& evidence, const ConfidenceFit::Volume& fit) {
  const double noise = evidence.roughness * evidence.spacing;
  return fit.intercept + fit.per_root_off * std::sqrt(1.0 - evidence.share) +
         fit.per_lost_score * (1.0 - evidence.score) / (kLostUnit + noise) +
         fit.per_missing_overlap * std::max(0.0, 1.0 - evidence.support);
}

}  // namespace

double seenSupport(const PlaneEvidence& evidence) {
  const double seen = evidence.support + evidence.conflict;
  if (!(seen > 0.0) || !(evidence.baseline > 0.0)) return 0.0;
  return std::min(1.0, evidence.support / (seen * evidence.baseline));
}

ShareInterval shareInterval(const PlaneEvidence& evidence) {
  return {evidence.share * (1.0 - evidence.unknown), evidence.share * (1.0 - evidence.unknown) + evidence.unknown};
}

double planeConfidence(const PlaneEvidence& evidence) {
  const double log_odds = evidence.partial  ? scanLogOdds(evidence, kConfidenceFit.scan)
                          : evidence.volume ? volumeLogOdds(evidence, kConfidenceFit.volume)
                                            : surfaceLogOdds(evidence, kConfidenceFit.surface);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace pcl_symmetry
