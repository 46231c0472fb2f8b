#pragma once

#include <vector>

#include "core/detection/detection_rules.h"
#include "core/detection/plane_fit.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// The strongest local maxima of the map, each basin of refinement once, and the planes across the principal axes.
/// \param map over planes in the input frame.
std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options);

/// Limits within which two planes are one, normalized frame.
inline constexpr PlaneTolerance kSamePlane{kDetection.stages.same_angle, kDetection.stages.same_offset};

/// Limits within which two maxima share one basin of refinement, normalized frame.
inline constexpr PlaneTolerance kSameBasin{kDetection.stages.same_basin_angle, kDetection.stages.same_basin_offset};

/// The reflection of one symmetry in another is a symmetry too: completes the group that some symmetries generate, and
/// the planes of a regular polygon of which some are known.
class GroupClosure {
public:
  /// \param cloud must outlive this object.
  explicit GroupClosure(const NormalizedCloud& cloud) : cloud_(cloud) {}

  /// \param planes found up to now, input frame; those that are symmetries count.
  /// \return such planes that neither are known nor were returned before; none for scans.
  std::vector<Candidate> next(const std::vector<SymmetryPlane>& planes);

private:
  const NormalizedCloud& cloud_;
  std::vector<ReflectionPlane> tried_;  ///< normalized frame
};

}  // namespace pcl_symmetry
