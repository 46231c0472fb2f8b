#pragma once

#include <cstdint>
#include <vector>

#include "core/detection/plane_decision.h"
#include "core/detection/plane_fit.h"

namespace pcl_symmetry {

/// A part of a surface, and a plane of symmetry of that part.
struct SymmetricPart {
  ReflectionPlane plane;     ///< normalized frame
  std::vector<int> points;   ///< some points of the part, spread over it, as ascending indices
  double share = 0.0;        ///< of the cloud, in [0, 1]
  double support = 0.0;      ///< mean support of these points, in [0, 1]
  int iterations = 0;        ///< of Iterative Symmetric Points
  double longer_edge = 0.0;  ///< of its region than a part of its size has, edges of a disc
};

struct PartSearchOptions {
  IspUpdate update;    ///< what a step of the refinement makes least
  std::uint64_t seed;  ///< of the samples that tell parts
  int num_threads;     ///< 0 = one per core
};

/// Symmetries of parts of a surface, as planes 2 to 4 of Figure 8.
///
/// Departure from the paper, which takes them from the local maxima of the transform of the whole shape: a small part
/// contributes too little to the transform to be a maximum. Here planes through the middles of balls, of several radii
/// and spread over the surface, are refined on the points of their ball alone, and then on the region that they map
/// onto itself (MatchedRegions), which tells a part from what matches by chance. A part has as many planes as it has.
/// \param cloud,fit of the surface.
/// \return large and well supported parts first; no two with the same plane.
std::vector<SymmetricPart> findSymmetricParts(const NormalizedCloud& cloud, const PlaneFit& fit,
                                              const PartSearchOptions& options);

/// Symmetries of parts of the surface.
/// \param known planes that have been found, input frame.
/// \return planes of PlaneKind::Local, input frame, unlike the symmetries and possible symmetries among those known.
std::vector<SymmetryPlane> localPlanes(const std::vector<SymmetryPlane>& known, const NormalizedCloud& cloud,
                                       const PlaneFit& fit, const PlaneJudge& judge, const DetectionOptions& options);

}  // namespace pcl_symmetry
