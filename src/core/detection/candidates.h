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
  int iterations = 0;      ///< of all stages
  bool converged = false;  ///< in the last stage
  IspStep step = {};       ///< matches of the plane nearby; none where points resolve no surface
  std::shared_ptr<const std::vector<int>> samples = {};  ///< indices of the points that `step` reflected
  double merit = 0.0;                                    ///< PlaneFit::merit() after the last stage
};

/// The strongest local maxima of the map, each basin of refinement once, and the planes across the principal axes.
/// \param map over planes in the input frame.
std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options);

/// \return those of some planes, input frame, that are of one of these kinds; in their order, normalized frame.
std::vector<ReflectionPlane> planesOf(const std::vector<SymmetryPlane>& planes, std::initializer_list<PlaneKind> kinds,
                                      const NormalizedCloud& cloud);

/// The reflection of one symmetry in another is a symmetry too: completes the group that some symmetries generate.
/// \param planes found up to now, input frame; those that are symmetries count.
/// \param[in,out] tried planes that were known or returned before, normalized frame.
/// \return such planes that are not among these.
std::vector<Candidate> impliedBy(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                 std::vector<ReflectionPlane>& tried);

/// Planes of a scan at right angles to two of its symmetries, or to one and to what carries it, spread along the
/// object. Not in the paper: half of what such a plane maps may be hidden, and a map of few samples has no maximum
/// there.
/// \param carrying_normals of what the object stands on.
std::vector<Candidate> atRightAngles(const std::vector<SymmetryPlane>& planes,
                                     const std::vector<Eigen::Vector3d>& carrying_normals,
                                     const NormalizedCloud& cloud);

}  // namespace pcl_symmetry
