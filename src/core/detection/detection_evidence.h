#pragma once

#include <vector>

#include "core/detection/plane_measure.h"
#include "core/rotation/rotation_evidence.h"

namespace pcl_symmetry {

/// The evidence behind the decisions of one detection, to which confidences are fitted.
struct DetectionEvidence {
  /// Candidates after all stages of refinement, each plane once, best merit first. They do not depend on fitted
  /// numbers.
  std::vector<MeasuredPlane> planes;
  std::vector<JudgedRotation> rotations;  ///< rotations of scans, whatever their confidence
};

/// detectPlanes(), with the evidence of its decisions.
/// \param evidence filled with the evidence of all candidates (doubles the time); may be null.
Detection detectWithEvidence(const PlaneInput& input, const DetectionOptions& options, DetectionEvidence* evidence);

}  // namespace pcl_symmetry
