#pragma once

#include <vector>

#include "core/refinement/part_search.h"
#include "core/refinement/plane_fit.h"
#include "pcl_symmetry/core/detection/plane_detection.h"

namespace pcl_symmetry {

/// From refined planes to answers: support, D, and the confidence that decides between symmetry, possible symmetry and
/// approximate symmetry (see evidence/README.md).
class PlaneJudge {
public:
  /// \param cloud,fit,options must outlive this object.
  PlaneJudge(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options);

  /// \param candidates after the last stage of refinement.
  /// \return one plane each, input frame, in the same order.
  std::vector<SymmetryPlane> judge(const std::vector<Candidate>& candidates) const;

  /// Planes of a family together.
  /// \param planes normalised frame, at least one.
  /// \param samples indices of the points that judge them.
  /// \return confidence, score and support; point and direction are zero.
  SymmetryAxis judgeFamily(const std::vector<ReflectionPlane>& planes, const std::vector<int>& samples) const;

  /// Symmetries of parts of the surface.
  /// \param known planes that have been found, input frame.
  /// \return local planes, input frame, unlike those known.
  std::vector<SymmetryPlane> findParts(const std::vector<SymmetryPlane>& known) const;

private:
  SymmetryPlane judged(const ReflectionPlane& plane, const PlaneShares& shares) const;

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  const DetectionOptions& options_;
};

}  // namespace pcl_symmetry
