/// Planes are judged one by one; these rules lower their odds by what was found beside them. Not in the paper.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/detection/set_confidence.h"
#include "core/evidence/plane_confidence.h"

namespace pcl_symmetry {

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

}  // namespace pcl_symmetry
