#pragma once

#include <initializer_list>
#include <memory>
#include <vector>

#include "core/refinement/iterative_symmetric_points.h"
#include "core/refinement/normalized_cloud.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// A plane on its way through the stages of refinement, normalized frame.
struct Candidate {
  ReflectionPlane plane;
  bool from_map = false;   ///< a maximum of the map, whose cell it must not leave
  int iterations = 0;      ///< number of iterations in all stages
  bool converged = false;  ///< whether the last stage converged
  IspStep step = {};       ///< matches of a nearby plane; none where points resolve no surface
  std::shared_ptr<const std::vector<int>> samples = {};  ///< indices of the points that `step` reflected
  double merit = 0.0;                                    ///< PlaneFit::merit() after the last stage
};

/// The strongest local maxima of the map, one per basin of refinement, and the planes perpendicular to the principal
/// axes.
/// \param map over planes in the input frame.
std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options);

/// \return the planes of the given kinds, in their order, transformed from the input frame to the normalized frame.
std::vector<ReflectionPlane> planesOf(const std::vector<SymmetryPlane>& planes, std::initializer_list<PlaneKind> kinds,
                                      const NormalizedCloud& cloud);

/// Completes the group that some symmetries generate: the reflection of one in another is a symmetry, too.
/// \param planes found so far, input frame; only symmetries are used.
/// \param[in,out] tried planes that were known or returned before, normalized frame.
/// \return the implied planes that are not among \p tried.
std::vector<Candidate> reflectSymmetries(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                         std::vector<ReflectionPlane>& tried);

/// Planes of a scan perpendicular to two of its symmetries, or to one of them and to its support, spread along the
/// object. Half of the surface that such a plane maps may be hidden, so that a map of few samples has no maximum there.
/// Not in the paper.
/// \param support_normals unit normals of the supports, as from supportNormals().
std::vector<Candidate> proposeAtRightAngles(const std::vector<SymmetryPlane>& planes,
                                            const std::vector<Eigen::Vector3d>& support_normals,
                                            const NormalizedCloud& cloud);

}  // namespace pcl_symmetry
