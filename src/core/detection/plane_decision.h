#pragma once

#include <vector>

#include "core/detection/plane_measure.h"

namespace pcl_symmetry {

// The only functions that write the confidence, the kind and the reasons of planes of the whole shape, measured on a
// cloud, a mesh, a volume, an upright box or a polygon (middlePlaneOfBox() returns a confidence, which
// decideByUprightBox() passes to setConfidence()); and the rules that lower the odds of a plane because of other
// findings. Not in the paper.

/// Sets the confidence of a plane, and its kind from min_confidence and min_possible. The evidence replaces all earlier
/// reasons except those that limit the plane to a possible symmetry.
/// \param confidence in [0, 1].
/// \param evidence what was measured, as Reason::rule.
void setConfidence(SymmetryPlane& plane, double confidence, const char* evidence, const DetectionOptions& options);

/// Changes the confidence by a rule that considers more than the evidence of the plane.
/// \param confidence in [0, 1].
void changeConfidence(SymmetryPlane& plane, double confidence, const char* rule, const DetectionOptions& options);

/// The same by a factor on the odds.
/// \param odds > 0; nothing changes at 1.
void multiplyOdds(SymmetryPlane& plane, double odds, const char* rule, const DetectionOptions& options);

/// A reason of limitToPossible().
inline constexpr const char* kPartOffRoundBody = "does not map onto itself the part of a round body that is not round";

/// Limits the plane to a possible symmetry from now on, whatever its confidence.
void limitToPossible(SymmetryPlane& plane, const char* rule);

/// Whether a plane is a symmetry or a possible one.
inline bool isDecided(const SymmetryPlane& plane) {
  return plane.kind == PlaneKind::Symmetry || plane.kind == PlaneKind::Possible;
}

/// Whether a plane explains a whole cloud, so that no piece of it is missing.
bool explainsAll(const SymmetryPlane& plane, CloudKind kind);

/// If one plane explains the whole cloud, no piece is missing: lowers the odds of planes that require a missing piece,
/// such as the plane across an open cup, which requires a lid.
/// \param planes planes of the whole shape, including those that follow from others.
void doubtMissingPieces(std::vector<SymmetryPlane>& planes, CloudKind kind, const DetectionOptions& options);

/// A scan or a cut hides part of an object, and many planes are tried: lowers the odds of all planes but the best, or
/// of all planes if a family was found, because they are symmetries less often.
/// \param has_family an axis or a center was found, which is better than all planes.
void doubtFurtherPlanes(std::vector<SymmetryPlane>& planes, bool has_family, CloudKind kind,
                        const DetectionOptions& options);

/// Lowers the odds of slanted planes: an object on a table was made to stand there, or lies on one of its sides, so
/// that nearly all of its planes are upright or level. Without a known support, no plane counts as slanted.
/// \param support_normals as from supportNormals().
void doubtSlantedPlanes(std::vector<SymmetryPlane>& planes, const std::vector<Eigen::Vector3d>& support_normals,
                        const DetectionOptions& options);

/// Planes in the order of the results; only decided ones unless `approximate` is set.
std::vector<SymmetryPlane> sortPlanes(std::vector<SymmetryPlane> planes, const DetectionOptions& options);

}  // namespace pcl_symmetry
