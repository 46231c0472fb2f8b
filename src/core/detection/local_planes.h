#pragma once

#include <vector>

#include "core/detection/plane_judge.h"

namespace pcl_symmetry {

/// Symmetries of parts of the surface.
/// \param known planes that have been found, input frame.
/// \return planes of PlaneKind::Local, input frame, unlike the symmetries and possible symmetries among those known.
std::vector<SymmetryPlane> localPlanes(const std::vector<SymmetryPlane>& known, const NormalizedCloud& cloud,
                                       const PlaneFit& fit, const PlaneJudge& judge, const DetectionOptions& options);

}  // namespace pcl_symmetry
