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
  double tolerance = 0.02;  ///< of that share, divided by the radius of the points, > 0
  double unknown = 0.0;     ///< share of the surface that says nothing: its reflection was not seen or was cut off
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

/// The summands of the log odds that a plane is a symmetry, before their coefficients. The first is 1; then
/// come those that fall as the evidence gets better, then the spacing or the noise, which says what to expect of the
/// others.
std::vector<double> logOddsTerms(const PlaneEvidence& evidence);

/// Limits of a share.
struct ShareInterval {
  double low, high;
};

/// \return the unit of the error of PlaneEvidence::share as an estimate for the whole object, > 0.
double shareUnit(const PlaneEvidence& evidence);

/// \return limits of the share of the whole object that the plane maps to within the tolerance of the object, which hold
/// in 95 of 100 cases; in [0, 1].
ShareInterval shareInterval(const PlaneEvidence& evidence);

/// Probability that the plane is a symmetry of the object: it maps 97 % of the surface to within the tolerance of the
/// surface. A logistic regression for each kind of evidence, see README.md beside the source.
/// \return in [0, 1].
double planeConfidence(const PlaneEvidence& evidence);

}  // namespace pcl_symmetry
