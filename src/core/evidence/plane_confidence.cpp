#include "core/evidence/plane_confidence.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/statistics.h"
#include "core/base/symmetric_solvers.h"
#include "core/evidence/confidence_fit.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/geometry_rules.h"
#include "core/geometry/plane_chart.h"

namespace pcl_symmetry {

namespace {

/// \return spacing of the samples, tolerances.
double coarseness(const PlaneEvidence& evidence) {
  return evidence.spacing / std::max(evidence.tolerance, 1e-6);
}

/// \return log odds as a function of the share of the surface that is off: 0 at the greatest share of a symmetry.
double byOff(double off, double unit) {
  return std::log((off + unit) / (1.0 - kSymmetricShare + unit));
}

double byShare(const PlaneEvidence& evidence, double unit) {
  return byOff(1.0 - evidence.share, unit);
}

/// \return the share of the surface that is off, extrapolated to finer points.
double resolvedOff(const PlaneEvidence& evidence) {
  const double off = 1.0 - evidence.share, coarse = coarseness(evidence);
  const double flat = evidence.flat ? std::min(1.0, kEvidenceUnits.flat_reach * coarse) : 0.0;
  return off > 0.0 ? off * std::exp(std::max(kEvidenceUnits.reach * coarse, flat)) : 0.0;  // not 0 times infinity
}

/// \return the share of the surface that is off, in units of its uncertainty.
double byPrecision(const PlaneEvidence& evidence) {
  const double unit = kEvidenceUnits.precision + kEvidenceUnits.precision_per_spacing * coarseness(evidence) +
                      kEvidenceUnits.precision_per_unknown * evidence.unknown;
  return std::min(resolvedOff(evidence), kEvidenceUnits.max_off) / unit;
}

/// \return log odds that grow as the matches constrain the plane less, the more so the more is hidden, >= 0.
double bySlipping(const PlaneEvidence& evidence) {
  const double slips =
      std::max(0.0, std::log(kEvidenceUnits.slipping / (evidence.stiffness + kEvidenceUnits.min_slipping)));
  return (kEvidenceUnits.slipping_seen + evidence.unknown) * slips;
}

/// \return the loss of D beyond that explained by the hidden or missing part.
double byUnexplainedLoss(const PlaneEvidence& evidence) {
  return std::max(0.0, 1.0 - evidence.score - kEvidenceUnits.hidden_loss * evidence.unknown);
}

/// \return log odds by the loss of D beyond that explained by noise.
double byExcess(const PlaneEvidence& evidence) {
  const double excess = evidence.own_score - evidence.score - kEvidenceUnits.min_excess;
  return std::log(std::max(0.0, excess) / kEvidenceUnits.excess + 1.0);
}

/// \return log odds by the lost overlap of densities.
double byLostOverlap(const PlaneEvidence& evidence) {
  return std::log(std::max(0.0, 1.0 - evidence.support) / kEvidenceUnits.lost_overlap + 1.0);
}

}  // namespace

double seenSupport(const PlaneEvidence& evidence) {
  const double seen = evidence.support + evidence.conflict;
  if (!(seen > 0.0) || !(evidence.baseline > 0.0)) return 0.0;
  return std::min(1.0, evidence.support / (seen * evidence.baseline));
}

std::vector<double> logOddsTerms(const PlaneEvidence& evidence) {
  switch (evidence.kind) {
    case CloudKind::Scan:
      return {1.0, byShare(evidence, kEvidenceUnits.scan_off),
              byOff(1.0 - evidence.double_share, kEvidenceUnits.double_off), byUnexplainedLoss(evidence),
              bySlipping(evidence)};
    case CloudKind::Volume:
      return {1.0, byShare(evidence, kEvidenceUnits.volume_off), byExcess(evidence), byLostOverlap(evidence),
              std::log((1.0 - evidence.own_score) / kEvidenceUnits.noise + 1.0)};
    default:
      return {1.0,
              byOff(resolvedOff(evidence), kEvidenceUnits.off + kEvidenceUnits.off_per_spacing * coarseness(evidence)),
              byPrecision(evidence),
              std::sqrt(evidence.unknown),
              coarseness(evidence),
              coarseness(evidence) * byUnexplainedLoss(evidence)};
  }
}

double shareUnit(const PlaneEvidence& evidence) {
  return kEvidenceUnits.off + kEvidenceUnits.off_per_spacing * coarseness(evidence) +
         evidence.roughness * evidence.spacing + kEvidence.unknown_share * evidence.unknown;
}

ShareInterval shareInterval(const PlaneEvidence& evidence) {
  const ShareInterval& error = kConfidenceFit.share_errors[static_cast<int>(evidence.kind)];
  const double unit = shareUnit(evidence);
  return {std::clamp(evidence.share + error.low * unit, 0.0, evidence.share),
          std::clamp(evidence.share + error.high * unit, evidence.share, 1.0)};
}

double planeConfidence(const PlaneEvidence& evidence) {
  const std::vector<double> terms = logOddsTerms(evidence);
  const auto& coefficients = kConfidenceFit.log_odds[static_cast<int>(evidence.kind)];
  // A flat cloud is judged by its outline alone, a scan by one side.
  const double by_spacing =
      evidence.kind == CloudKind::Scan ? std::min(1.0, evidence.tolerance_raise / kEvidence.surely_coarser) : 0.0;
  const double tells_little = evidence.flat ? 1.0 : by_spacing;
  const double coarsest = kEvidence.coarsest + tells_little * (kEvidence.coarsest_part - kEvidence.coarsest);
  const double unresolved = kEvidence.lost_per_coarseness * std::max(0.0, coarseness(evidence) - coarsest);
  const double log_odds = std::inner_product(terms.begin(), terms.end(), coefficients.begin(), 0.0) - unresolved;
  return logistic(log_odds);
}

double furtherTerm(CloudKind kind, double unknown) {
  return kind == CloudKind::Scan ? 1.0 : kind == CloudKind::Surface ? std::sqrt(unknown) : 0.0;
}

double furtherOdds(CloudKind kind, double unknown) {
  return std::exp(furtherTerm(kind, unknown) * kConfidenceFit.log_odds[static_cast<int>(kind)].back());
}

Eigen::Matrix3d motionStiffness(const Points& points, const Points& normals, const std::vector<char>& matched,
                                const ReflectionPlane& plane) {
  const PlaneChart chart(plane, Eigen::Vector3d::Zero());
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < matched.size(); ++i) {
    if (!matched[i]) continue;
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d x = points.col(column).cast<double>(), normal = normals.col(column).cast<double>();
    const double height = -plane.signedDistance(x);  // height of the point whose reflection is x
    const Eigen::Vector3d gradient = chart.slope(x + 2.0 * height * chart.n, height, normal);
    information += gradient * gradient.transpose();
    count += 1.0;
  }
  return count > 0.0 ? Eigen::Matrix3d(information / count) : information;
}

double offsetStiffness(const Eigen::Matrix3d& stiffness) {
  Eigen::Matrix2d tilts = stiffness.topLeftCorner<2, 2>();
  tilts.diagonal().array() += kEvidence.tilt_ridge;
  const Eigen::Vector2d coupling = stiffness.topRightCorner<2, 1>();
  return std::max(0.0, stiffness(2, 2) - coupling.dot(solveSymmetric(tilts, coupling)));
}

double secondStiffness(const Eigen::Matrix3d& stiffness) {
  const SymmetricEigen<Eigen::Matrix3d> solver(stiffness);
  return std::max(0.0, solver.eigenvalues()[1]);
}

}  // namespace pcl_symmetry
