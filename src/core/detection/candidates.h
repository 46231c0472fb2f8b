#pragma once

#include <vector>

#include "core/detection/plane_fit.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// Where candidate planes come from: maxima of the map, principal axes, and symmetries that imply others.

/// The strongest local maxima of the map, each basin of refinement once, and the planes across the principal axes.
/// \param map over planes in the input frame.
std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options);

/// Limits within which two planes are one.
inline PlaneTolerance mergeTolerance(const DetectionOptions& options) {
  return {options.expert.merge_angle, options.expert.merge_offset};
}

/// Limits within which two maxima share one basin of refinement, normalized frame.
PlaneTolerance basinTolerance();

/// The reflection of one symmetry in another is a symmetry too: completes the group that some symmetries generate, and
/// the planes of a regular polygon of which some are known.
class GroupClosure {
public:
  /// \param cloud must outlive this object.
  /// \param tolerance planes within it are one.
  GroupClosure(const NormalizedCloud& cloud, const PlaneTolerance& tolerance) : cloud_(cloud), tolerance_(tolerance) {}

  /// \param planes found up to now, input frame; those that are symmetries count.
  /// \return such planes that neither are known nor were returned before; none for scans.
  std::vector<Candidate> next(const std::vector<SymmetryPlane>& planes);

private:
  const NormalizedCloud& cloud_;
  PlaneTolerance tolerance_;
  std::vector<ReflectionPlane> tried_;  ///< normalized frame
};

}  // namespace pcl_symmetry
