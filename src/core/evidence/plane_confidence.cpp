#include "core/evidence/plane_confidence.h"

#include <algorithm>
#include <cmath>

namespace pcl_symmetry {

double seenSupport(const PlaneEvidence& evidence) {
  const double seen = evidence.support + evidence.conflict;
  if (!(seen > 0.0) || !(evidence.baseline > 0.0)) return 0.0;
  return std::min(1.0, evidence.support / (seen * evidence.baseline));
}

/// Calibrated on 200 models of the training half of the Princeton Shape Benchmark (every fourth by name, from the third
/// on), as whole clouds of 500 to 10 000 points with noise of 0 to 2 % of the diagonal and as single-view scans;
/// symmetric: a plane maps 97 % of the area onto the surface within half a per cent of the diagonal; asymmetric: no
/// plane maps 90 %. All are logistic regressions rounded by hand, the intercepts
/// of the last two so that few of the asymmetric models pass.
double planeConfidence(const PlaneEvidence& evidence) {
  const double unexplained = 1.0 - seenSupport(evidence);
  const double lost = 1.0 - evidence.score;
  double logit = 0.0;
  if (evidence.partial) {
    // A high D is worth less where much of the surface finds a counterpart anyway; below 0.42 support would count
    // against a plane, which was not meant.
    logit =
        -5.5 - 14.0 * std::sqrt(unexplained) - 3.3 * std::log(std::max(evidence.support, 0.42)) + 10.5 * evidence.score;
  } else if (evidence.volume) {
    logit = 4.3 - 46.0 * (1.0 - evidence.support) - 77.0 * lost;
  } else {
    // Both in units of what sampling alone makes of a symmetry: normals of rough surfaces are uncertain, and the
    // distance transform of fewer points is noisier.
    const double excess = (unexplained - 0.03 * evidence.roughness) / (0.01 + 0.3 * evidence.spacing);
    const double lost_excess = lost / (0.003 + 2.0 * evidence.spacing * evidence.spacing);
    logit = 4.5 - 2.0 * excess - 0.2 * lost_excess;
  }
  return 1.0 / (1.0 + std::exp(-logit));
}

}  // namespace pcl_symmetry
