#pragma once

#include <vector>

namespace pcl_symmetry {

/// What the points say about one plane, and how finely they sample the surface.
struct PlaneEvidence {
  double support = 0.0;    ///< mean over the points: the reflection lies on the surface, in [0, 1]
  double conflict = 0.0;   ///< mean over the points: the reflection lies where there is nothing, in [0, 1]
  double score = 0.0;      ///< D of equation 2, in [0, 1]
  double own_score = 1.0;  ///< what noise leaves of D for a symmetry, in [0.5, 1]; 1 where points resolve a surface
  double baseline = 1.0;   ///< support of the points on the surface of all others: < 1 by sampling and noise
  double spacing = 0.0;    ///< median distance of the samples, divided by the radius of the points
  double roughness = 0.0;  ///< median distance of the samples from their tangent planes, divided by the spacing
  bool partial = false;    ///< seen from one viewpoint
  bool volume = false;     ///< the points resolve no surface; support is the overlap of their density
  /// Share of the surface mapped to within the tolerance of the surface, of that which says something, in [0, 1].
  double share = 1.0;
  double double_share = 1.0;  ///< the same within twice the tolerance, >= share
  double hold = 1.0;          ///< of scans: how firmly what is matched holds the plane, see secondStiffness(), >= 0
  double tolerance = 0.02;    ///< of that share, divided by the radius of the points, > 0
  double unknown = 0.0;       ///< share of the surface that says nothing: its reflection was not seen or was cut off
  bool flat = false;          ///< all points lie in one plane: the outline alone tells
  bool further = false;       ///< another plane of the same cloud has better evidence
};

/// Share of the surface seen that the plane maps onto the surface, relative to what sampling allows.
/// \return min(1, support / ((support + conflict) * baseline)), in [0, 1]; 0 where nothing was seen.
double seenSupport(const PlaneEvidence& evidence);

/// Each kind of evidence has coefficients of its own.
enum class EvidenceKind {
  Surface,  ///< a cloud that may lack a piece
  Scan,     ///< seen from one viewpoint
  Volume    ///< the points resolve no surface
};

EvidenceKind kindOf(const PlaneEvidence& evidence);

/// What the evidence is divided by before it counts: how exactly it is known. `calibrate_planes -sensitivity` prints
/// what half and twice of each does.
struct EvidenceUnits {
  /// Error of the share that is off: of clouds without noise, the same per spacing in tolerances, and of scans, whose
  /// hidden parts may differ. chosen: by a prototype on 11 to 14 symmetric planes each of whole clouds of 40 000, 10
  /// 000, 3000 and 1000 points, 95 % of which had an error of at most 0.006, 0.007, 0.02 and 0.027; half lets sampling
  /// decide, twice blurs 3 %.
  double off = 0.005, off_per_spacing = 0.002, scan_off = 0.01;
  /// The same of the share of scans within twice the tolerance. chosen: among 0.0025, 0.005 and 0.01 by
  /// cross-validation over the models of fold 0: 0.193, 0.192 and 0.192 nats a plane.
  double double_off = 0.005;
  /// How exactly the share is known: twice the errors of the share that is off, less where much says nothing; and from
  /// where on it does not matter. chosen: with half of them nearly symmetric planes are possible ones, with twice of
  /// them symmetries are doubted.
  double precision = 0.01, precision_per_spacing = 0.004, precision_per_unknown = 0.2, most_off = 0.1;
  /// Logarithm of the factor per spacing in tolerances by which finer points of a whole cloud show more of the surface
  /// to be off: samples reach beyond the edges of what is there. chosen: among 0.2, 0.3, 0.43 and 0.6 by
  /// cross-validation over whole and cut clouds of half of the models of fold 0: 0.1340, 0.1319, 0.1294 and 0.1287 nats
  /// a plane, 0.141 without; from 0.43 on clouds that were cut are doubted more, and clouds of 1000 to 3000 points. The
  /// off share of planes with a true one of 0.03 to 0.04 grows by 0.3 to 0.6 per spacing.
  double reach = 0.3;
  /// Part of D that is lost per share that says nothing. chosen: among 0.4, 0.6 and 0.8 by cross-validation over
  /// the models of fold 0: 0.194, 0.192 and 0.196 nats a plane of scans, 0.145 each of surfaces; 0.213 and 0.148
  /// without.
  double hidden_loss = 0.6;
  /// How firmly a scan has to hold a plane, and what is as good as free. chosen: nine of ten symmetries that
  /// scans of fold 0 show have more than 0.06; the first among 0.01, 0.03 and 0.1 by cross-validation over the models
  /// of fold 0: 0.192 nats a plane with each, 0.195 without.
  double slipping = 0.03, least_slipping = 0.001;
  /// What slips where nothing is hidden, as a share that is. chosen: by cross-validation over scans of folds 0 and 1:
  /// 0.197 nats a plane, 0.198 without the share that is hidden, 0.200 with the root of that alone.
  double slipping_seen = 0.3;
  /// Where points resolve no surface: of the share, of D beyond its error, and of the overlap. chosen: among 0.001 to
  /// 0.01, 0.0005 to 0.004, and 0.003 to 0.03, by cross-validation over models of what calibrate_planes -csv writes:
  /// all within 0.002 nats a plane of noisy clouds.
  double volume_off = 0.003, excess = 0.002, lost_overlap = 0.01;
  /// The error of D there. measured: D of the true planes of 20 noisy shapes with folds is 0.001 less than is expected
  /// of it in the mean, with a deviation of 0.002. Cross-validation as above: 0.139, 0.137 and 0.139 nats a plane with
  /// 0.001, 0.002 and 0.003, 0.144 without.
  double least_excess = 0.002;
  /// Of what noise takes from D. chosen: 0.163 nats a plane by cross-validation as above, 0.165 with the square root,
  /// 0.164 with one that ends at 0.06, with which 0.9 in place of 0.3 % of 640 random clouds of the tuning half pass.
  double noise = 0.01;
};

/// The summands of the log odds that a plane is a symmetry, before their coefficients. The first is 1; then
/// come those that fall as the evidence gets better, then the spacing or the noise, which says what to expect of the
/// others. The last one of scans and of surfaces is that of PlaneEvidence::further.
std::vector<double> logOddsTerms(const PlaneEvidence& evidence, const EvidenceUnits& units = {});

/// Limits of a share.
struct ShareInterval {
  double low, high;
};

/// \return the unit of the error of PlaneEvidence::share as an estimate for the whole object, > 0.
double shareUnit(const PlaneEvidence& evidence);

/// \return limits of the share of the whole object that the plane maps to within the tolerance of the object, which hold
/// in 95 of 100 cases; in [0, 1].
ShareInterval shareInterval(const PlaneEvidence& evidence);

/// Probability that the plane is a symmetry of the object: it, or a plane within 3 degrees and 2 % of the diagonal,
/// maps 97 % of the surface to within the tolerance of the surface. A logistic regression for each kind of evidence,
/// see README.md beside the source.
/// \return in [0, 1].
double planeConfidence(const PlaneEvidence& evidence);

/// What PlaneEvidence::further makes of a confidence: less for a scan, and for a cloud that may lack a piece.
/// \param confidence of the plane by itself, in [0, 1].
/// \param unknown as PlaneEvidence::unknown.
double furtherConfidence(double confidence, EvidenceKind kind, double unknown);

}  // namespace pcl_symmetry
