#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// How strongly the matched samples constrain a plane. A match excludes some motions: a sheet reflected onto itself
/// matches under any tilt of the plane about the normal of the sheet, a ball under all tilts.
/// \param points 3 x N, in the unit ball, the reflections of the samples.
/// \param normals 3 x N, unit, of the surface at their matches.
/// \param matched N values.
/// \param plane in the frame of the points.
/// \return mean outer product of the derivatives of a match's distance by two tilts (radians) and the offset, in this
/// order; symmetric, eigenvalues in [0, 12]; 0 without matches.
Eigen::Matrix3d motionStiffness(const Points& points, const Points& normals, const std::vector<char>& matched,
                                const ReflectionPlane& plane);

/// How strongly the matches constrain the offset of a plane: in a tube, only matches at the ends do.
/// \param stiffness of motionStiffness().
/// \return mean squared derivative of a match's distance by the offset, after the best tilt, in [0, 4].
double offsetStiffness(const Eigen::Matrix3d& stiffness);

/// How strongly a plane is constrained apart from its freest motion, as planes through an axis have one free motion.
/// \param stiffness of motionStiffness().
/// \return the second of its three eigenvalues, in [0, 6].
double secondStiffness(const Eigen::Matrix3d& stiffness);

/// How a cloud shows an object. The coefficients of the evidence and the rules of detection depend on it
/// (core/detection/detection_rules.h).
enum class CloudKind {
  Surface,  ///< the surface from all sides; a piece may be missing
  Scan,     ///< the surface seen from one viewpoint, or from a few
  Volume    ///< the points resolve no surface: noise beyond their spacing puts neighbors on all sides
};

/// Evidence for and against one plane, and how finely the points sample the surface.
struct PlaneEvidence {
  double support = 0.0;    ///< mean over the points of how well the reflection lies on the surface, in [0, 1]
  double conflict = 0.0;   ///< mean over the points of how well the reflection lies in free space, in [0, 1]
  double score = 0.0;      ///< D of Equation 2, in [0, 1]
  double own_score = 1.0;  ///< D that a symmetry has under this noise, in [0.5, 1]; 1 where points resolve a surface
  double baseline = 1.0;   ///< mean support of the points by the surface of all others: < 1 due to sampling and noise
  double spacing = 0.0;    ///< median distance of the samples, divided by the radius of the points
  double roughness = 0.0;  ///< median distance of the samples from their tangent planes, divided by the spacing
  CloudKind kind = CloudKind::Surface;  ///< kind of the cloud; the support of a volume is the overlap of its density
  /// Share of the informative surface that is mapped to within the tolerance of the surface, in [0, 1].
  double share = 1.0;
  double double_share = 1.0;  ///< share mapped to within twice the tolerance, >= share
  double stiffness = 1.0;     ///< second eigenvalue of the motion stiffness of a scan, see secondStiffness(), >= 0
  double tolerance = 0.02;    ///< tolerance of `share`, divided by the radius of the points, > 0
  double unknown = 0.0;  ///< share of the surface that is uninformative: its reflection was not seen or was cut off
  bool flat = false;     ///< whether all points lie in one plane, so that only their outline is informative
  double tolerance_raise = 0.0;  ///< share by which the spacing of the points raised the tolerance, >= 0
};

/// Share of the visible surface that the plane maps onto the surface, relative to what sampling allows.
/// \return min(1, support / ((support + conflict) * baseline)), in [0, 1]; 0 where nothing was seen.
double seenSupport(const PlaneEvidence& evidence);

/// Uncertainties of the evidence, by which it is divided. Chosen by cross-validation over the models of the fit.
struct EvidenceUnits {
  double off = 0.005;              ///< error of the share that is off, for clouds without noise
  double off_per_spacing = 0.002;  ///< increase of that error per spacing in tolerances
  double scan_off = 0.01;          ///< error of the share that is off, for scans, whose hidden parts may differ
  double double_off = off;         ///< error of the share that is off by more than twice the tolerance
  double precision = 2.0 * off;    ///< uncertainty of the share; half of it would doubt nearly symmetric planes less
  double precision_per_spacing = 2.0 * off_per_spacing;  ///< increase of `precision` per spacing in tolerances
  double precision_per_unknown = 0.2;                    ///< increase of `precision` per uninformative share
  double max_off = 0.1;                                  ///< share that is off above which more makes no difference
  /// Logarithm of the factor per spacing in tolerances by which the share that is off grows with finer points of a
  /// whole cloud, because samples extend beyond edges: 0.3 to 0.6 for planes that map 96 to 97 %.
  double reach = 0.3;
  double flat_reach = 0.8;      ///< `reach` for flat clouds, where only the outline is informative, up to a factor of e
  double hidden_loss = 0.6;     ///< loss of D per uninformative share
  double slipping = 0.03;       ///< stiffness below which a plane may slip; nine of ten symmetries have more than 0.06
  double min_slipping = 0.001;  ///< below this stiffness a plane counts as free
  double slipping_seen = 0.3;   ///< weight of the term for slipping where nothing is hidden
  // For points that resolve no surface:
  double volume_off = 0.003;   ///< error of the share that is off
  double excess = 0.002;       ///< unit of the loss of D beyond its error
  double min_excess = excess;  ///< error of D: it is 0.001 less than expected on average, with a deviation of 0.002
  double lost_overlap = 0.01;  ///< unit of the lost overlap of densities
  double noise = 0.01;         ///< unit of the loss of D through noise
};
inline constexpr EvidenceUnits kEvidenceUnits{};

/// The terms of the log odds that a plane is a symmetry, without their coefficients: 1, then terms that fall with
/// better evidence, then for whole clouds and volumes the spacing or the noise, which the other terms depend on.
std::vector<double> logOddsTerms(const PlaneEvidence& evidence);

/// Limits of a share, in [0, 1].
struct ShareInterval {
  double low, high;
};

/// \return the unit of the error of PlaneEvidence::share as an estimate for the whole object, > 0.
double shareUnit(const PlaneEvidence& evidence);

/// \return limits of the share of the whole object that the plane maps to within the tolerance of the object, which
/// hold in 95 of 100 cases; in [0, 1].
ShareInterval shareInterval(const PlaneEvidence& evidence);

/// Probability that the plane is a symmetry of the object: this plane, or one within 3 degrees and 2 % of the diagonal,
/// maps 97 % of the surface to within the tolerance of the surface. A logistic regression for each kind of cloud, see
/// src/pages/algorithms/decision.md.
/// \return in [0, 1].
double planeConfidence(const PlaneEvidence& evidence);

/// The last term of the log odds, for a plane of a cloud that has a better plane: it grows with the unknown share.
/// \param unknown see PlaneEvidence::unknown.
double furtherTerm(CloudKind kind, double unknown);

/// The factor of furtherTerm() on the odds: less for a scan and for a cloud that may lack a piece.
/// \return a factor, > 0.
double furtherOdds(CloudKind kind, double unknown);

}  // namespace pcl_symmetry
