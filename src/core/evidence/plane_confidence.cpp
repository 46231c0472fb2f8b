#include "core/evidence/plane_confidence.h"

#include <algorithm>
#include <cmath>

namespace pcl_symmetry {

namespace {

/// The sixteen numbers of the decision; log odds, so that each summand has unit 1.
///
/// fitted: logistic regressions on 200 models of the training half of the Princeton Shape Benchmark (every fourth by
/// name, from the third on), as whole clouds of 500 to 10 000 points with noise of 0 to 2 % of the diagonal and as
/// single-view scans. Symmetric: a plane maps 97 % of the area to within 0.5 % of the diagonal of the surface.
/// Asymmetric: no plane maps 90 %. The coefficients were rounded by hand. The intercepts of volumes and whole clouds
/// were then set by hand so that few of the asymmetric models pass. Support was redefined at edges after the fit.
struct ConfidenceFit {
  struct Scan {
    double intercept = -5.5, per_root_unexplained = -14.0, per_log_support = -3.3, per_score = 10.5;
    double least_support = 0.42;  ///< set by hand: below it, less support would raise the confidence
  } scan;
  struct Volume {
    double intercept = 4.3, per_missing_overlap = -46.0, per_lost_score = -77.0;
  } volume;
  struct Whole {
    double intercept = 4.5, per_unexplained = -2.0, per_lost_score = -0.2;
    /// What sampling alone makes of a symmetry: normals of rough surfaces are uncertain, and the distance transform of
    /// fewer points is noisier.
    double unexplained_per_roughness = 0.03;
    double unexplained_unit = 0.01, unexplained_unit_per_spacing = 0.3;
    double lost_unit = 0.003, lost_unit_per_sq_spacing = 2.0;
  } whole;
};
constexpr ConfidenceFit kFit{};  // fitted: see above

double scanLogOdds(const PlaneEvidence& evidence, const ConfidenceFit::Scan& fit) {
  const double unexplained = 1.0 - seenSupport(evidence);
  // A high D is worth less where much of the surface finds a counterpart anyway.
  return fit.intercept + fit.per_root_unexplained * std::sqrt(unexplained) +
         fit.per_log_support * std::log(std::max(evidence.support, fit.least_support)) + fit.per_score * evidence.score;
}

double volumeLogOdds(const PlaneEvidence& evidence, const ConfidenceFit::Volume& fit) {
  return fit.intercept + fit.per_missing_overlap * (1.0 - evidence.support) +
         fit.per_lost_score * (1.0 - evidence.score);
}

double wholeLogOdds(const PlaneEvidence& evidence, const ConfidenceFit::Whole& fit) {
  const double unexplained = 1.0 - seenSupport(evidence), lost = 1.0 - evidence.score;
  const double excess = (unexplained - fit.unexplained_per_roughness * evidence.roughness) /
                        (fit.unexplained_unit + fit.unexplained_unit_per_spacing * evidence.spacing);
  const double lost_excess =
      lost / (fit.lost_unit + fit.lost_unit_per_sq_spacing * evidence.spacing * evidence.spacing);
  return fit.intercept + fit.per_unexplained * excess + fit.per_lost_score * lost_excess;
}

}  // namespace

double seenSupport(const PlaneEvidence& evidence) {
  const double seen = evidence.support + evidence.conflict;
  if (!(seen > 0.0) || !(evidence.baseline > 0.0)) return 0.0;
  return std::min(1.0, evidence.support / (seen * evidence.baseline));
}

double planeConfidence(const PlaneEvidence& evidence) {
  const double log_odds = evidence.partial  ? scanLogOdds(evidence, kFit.scan)
                          : evidence.volume ? volumeLogOdds(evidence, kFit.volume)
                                            : wholeLogOdds(evidence, kFit.whole);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace pcl_symmetry
