/// The search behind findReferenceSymmetries(): planes from the transform and principal axes, then their families.
#pragma once

#include "common/scanner/triangle_scene.h"
#include "evaluate/references/reference_symmetries.h"

namespace pcl_symmetry::apps {

/// \param options with the tolerance in diagonals.
/// \return symmetries in the frame of the scene, which is centred and has unit diagonal; without diagonal,
/// diameter, tolerance and center.
ReferenceSymmetries searchReferences(const TriangleScene& scene, const ReferenceOptions& options);

}  // namespace pcl_symmetry::apps
