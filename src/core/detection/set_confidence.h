/// The only functions that write the confidence, the kind and the reasons of a plane, whatever its evidence is of: a
/// cloud, a mesh, a volume, an upright box or a polygon. Not in the paper.
#pragma once

#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// Sets the confidence of a plane, and its kind from min_confidence and min_possible. The evidence replaces all that
/// came before; what limits the plane to a possible symmetry stays.
/// \param confidence in [0, 1].
/// \param evidence what it is of; Reason::rule.
void setConfidence(SymmetryPlane& plane, double confidence, const char* evidence, const DetectionOptions& options);

/// Sets another confidence by a rule that looks beside the evidence.
/// \param confidence in [0, 1].
void changeConfidence(SymmetryPlane& plane, double confidence, const char* rule, const DetectionOptions& options);

/// The same by a factor on the odds.
/// \param odds > 0; nothing changes at 1.
void multiplyOdds(SymmetryPlane& plane, double odds, const char* rule, const DetectionOptions& options);

/// From now on the plane is a possible symmetry at most, whatever sets its confidence.
void limitToPossible(SymmetryPlane& plane, const char* rule);

/// A symmetry of the points that support it.
void setLocal(SymmetryPlane& plane);

/// True of symmetries and possible ones.
inline bool isDecided(const SymmetryPlane& plane) {
  return plane.kind == PlaneKind::Symmetry || plane.kind == PlaneKind::Possible;
}

}  // namespace pcl_symmetry
