#pragma once

#include <optional>
#include <vector>

#include "core/detection/plane_fit.h"
#include "core/detection/plane_lattice.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// The planes that are reported: best first, each maximum once, as many as the options ask for.
///
/// Order: symmetries, then possible ones, both by falling confidence, then approximate and local ones by falling
/// support.
/// \param planes input frame.
/// \param polygon whose planes are all of them maxima, normalised frame.
/// \return with the support of every point.
std::vector<SymmetryPlane> rankedPlanes(std::vector<SymmetryPlane> planes, const std::optional<PlaneLattice>& polygon,
                                        const NormalizedCloud& cloud, const PlaneFit& fit,
                                        const DetectionOptions& options);

/// \return the plane of a cloud of which nothing but a sheet is left at the tolerance, input frame; else empty.
std::optional<ReflectionPlane> flatPlane(const NormalizedCloud& cloud, Thinness thinness);

/// The answer where nothing is a symmetry: of the planes of the whole, the one with the greatest share.
/// \param planes input frame.
/// \return with the support of every point; empty where a plane is a symmetry or a possible one, or there is none.
std::optional<SymmetryPlane> bestApproximate(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                             const PlaneFit& fit);

}  // namespace pcl_symmetry
