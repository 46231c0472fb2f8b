#pragma once

namespace pcl_symmetry {

/// What the points say about one plane, and how finely they sample the surface.
struct PlaneEvidence {
  double support;    ///< mean over the points: the reflection lies on the surface
  double conflict;   ///< mean over the points: the reflection lies where there is nothing
  double score;      ///< D
  double baseline;   ///< support of the points themselves on the surface of all others: below 1 by sampling and noise
  double spacing;    ///< median of the samples, of the radius
  double roughness;  ///< median, of the spacing
  bool partial;      ///< seen from one viewpoint
  bool volume;       ///< the points resolve no surface; support is the overlap of densities
};

/// Share of what is seen of the surface that the plane maps onto the surface, as far as sampling lets it, in [0, 1].
double seenSupport(const PlaneEvidence& evidence);

/// Probability that the plane is a symmetry of the object, in [0, 1]: logistic functions of a few of the values above,
/// fifteen numbers in all, calibrated once (see the definition).
double planeConfidence(const PlaneEvidence& evidence);

}  // namespace pcl_symmetry
