#pragma once

#include <vector>

#include "core/detection/plane_measure.h"

namespace pcl_symmetry {

// The only functions that write the confidence, the kind and the reasons of a plane of a whole, whatever was measured:
// a cloud, a mesh, a volume, an upright box or a polygon; and the rules that lower its odds by what was found beside
// it. Not in the paper.

/// Sets the confidence of a plane, and its kind from min_confidence and min_possible. The evidence replaces all that
/// came before; what limits the plane to a possible symmetry stays.
/// \param confidence in [0, 1].
/// \param evidence what was measured, as Reason::rule.
void setConfidence(SymmetryPlane& plane, double confidence, const char* evidence, const DetectionOptions& options);

/// Sets another confidence by a rule that looks beside the evidence.
/// \param confidence in [0, 1].
void changeConfidence(SymmetryPlane& plane, double confidence, const char* rule, const DetectionOptions& options);

/// The same by a factor on the odds.
/// \param odds > 0; nothing changes at 1.
void multiplyOdds(SymmetryPlane& plane, double odds, const char* rule, const DetectionOptions& options);

/// From now on the plane is a possible symmetry at most, whatever sets its confidence.
void limitToPossible(SymmetryPlane& plane, const char* rule);

/// Whether a plane is a symmetry or a possible one.
inline bool isDecided(const SymmetryPlane& plane) {
  return plane.kind == PlaneKind::Symmetry || plane.kind == PlaneKind::Possible;
}

/// Whether a plane explains all of a whole cloud, so that nothing of it is missing.
bool explainsAll(const SymmetryPlane& plane, CloudKind kind);

/// Where a plane explains all of a cloud, nothing of it is missing: those that need a missing piece are doubted, such
/// as the plane across an open cup, which needs a lid.
/// \param planes of the whole, also those that follow from others.
void doubtMissingPieces(std::vector<SymmetryPlane>& planes, CloudKind kind, const DetectionOptions& options);

/// A scan or a cut hides a part of an object, and many planes are tried: those beside the best one, or beside a
/// family, are symmetries less often.
/// \param has_family an axis or a center was found, which is better than all planes.
void doubtFurtherPlanes(std::vector<SymmetryPlane>& planes, bool has_family, CloudKind kind,
                        const DetectionOptions& options);

/// An object on a table was made to stand there, or lies on one of its sides: nearly all of its planes are upright or
/// level. Without a known support, no plane is slanted.
/// \param carrying_normals as from carryingNormals().
void doubtSlantedPlanes(std::vector<SymmetryPlane>& planes, const std::vector<Eigen::Vector3d>& carrying_normals,
                        const DetectionOptions& options);

/// Planes in the order of answers, without `approximate` only those that are decided.
std::vector<SymmetryPlane> reordered(std::vector<SymmetryPlane> planes, const DetectionOptions& options);

}  // namespace pcl_symmetry
