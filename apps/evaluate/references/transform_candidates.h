/// Candidates of references from this library's own transform: for comparison with the search by brute force.
#pragma once

#include <vector>

#include "evaluate/references/reference_symmetries.h"
#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry::apps {

/// Maxima of the transform without thresholds, and planes across the principal axes: what the detector starts from too,
/// so that a plane that the transform does not show is missed by both.
/// \param samples of the surface, spread by area, in a frame of unit diagonal.
std::vector<ReflectionPlane> transformCandidates(const Points& samples, const ReferenceOptions& options);

}  // namespace pcl_symmetry::apps
