#pragma once

#include <optional>
#include <vector>

#include "core/detection/plane_search.h"

namespace pcl_symmetry {

/// The planes that are reported: best first, each maximum once, at most DetectionOptions::max_planes.
///
/// Order: symmetries, then possible ones, both by falling confidence, then approximate and local ones by falling
/// support.
/// \param planes input frame.
/// \param polygon normalized frame; each of its planes is a maximum.
/// \return with the support of every point.
std::vector<SymmetryPlane> rankedPlanes(const PlaneSearch& search, std::vector<SymmetryPlane> planes,
                                        const std::optional<PlaneLattice>& polygon = std::nullopt);

/// The plane of the whole shape with the greatest share, for shapes without a symmetry.
/// \param planes input frame.
/// \return a plane with the support of every point; none if a plane is a symmetry or a possible one, or there is no
/// plane.
std::optional<SymmetryPlane> bestApproximate(const PlaneSearch& search, const std::vector<SymmetryPlane>& planes);

/// From what was found to the answer: ranks the planes, and fills the fields of the whole cloud.
void report(const PlaneSearch& search, Found& found);

}  // namespace pcl_symmetry
