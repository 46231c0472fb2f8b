#pragma once

#include <optional>
#include <vector>

#include "core/detection/plane_search.h"

namespace pcl_symmetry {

/// The planes that are reported: best first, each maximum once, at most DetectionOptions::max_planes.
///
/// They are ordered as symmetries, then possible ones, both by decreasing confidence, then approximate and local ones
/// by decreasing support.
/// \param planes input frame.
/// \param polygon normalized frame; each of its planes is a maximum.
/// \return the planes, with the support of every point.
std::vector<SymmetryPlane> selectReported(const PlaneSearch& search, std::vector<SymmetryPlane> planes,
                                          const std::optional<PlaneLattice>& polygon = std::nullopt);

/// The plane of the whole shape with the greatest share, for shapes without a symmetry.
/// \param planes input frame.
/// \return a plane with the support of every point; nothing if a plane is a symmetry or a possible one, or there is no
/// plane.
std::optional<SymmetryPlane> bestApproximate(const PlaneSearch& search, const std::vector<SymmetryPlane>& planes);

/// Turns what was found into the answer: selects the planes to report, and fills the fields that describe the whole
/// cloud.
void report(const PlaneSearch& search, DetectionState& state);

}  // namespace pcl_symmetry
