#pragma once

#include <vector>

#include "core/detection/plane_fit.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// From candidates to precise planes in three stages, each with more samples and narrower weights than the one before
/// (Section 4.4).
///
/// After the first two stages, candidates that ended at the same plane are merged, and of those that are no symmetries
/// of a whole cloud only the best go on.
class StagedRefinement {
public:
  /// \param cloud,fit,options must outlive this object.
  StagedRefinement(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options);

  /// Few samples and wide weights: most candidates end in a basin that another one found, or leave their cell.
  /// \param grid whose cells candidates from the map must not leave.
  std::vector<Candidate> coarse(std::vector<Candidate> candidates, const PlaneGrid& grid) const;

  /// More samples; the weights end as narrow as the spacing of the points allows.
  std::vector<Candidate> close(std::vector<Candidate> candidates) const;

  /// The same for reflections of symmetries, which must be symmetries themselves.
  std::vector<Candidate> closeSymmetries(std::vector<Candidate> candidates) const;

  /// All samples at the narrowest weights: this stage decides the precision of the planes.
  std::vector<Candidate> full(std::vector<Candidate> candidates) const;

  /// Moves planes of a whole cloud to their optimum where pairs without a true partner pull them aside.
  /// \param candidates after full(), those that may be symmetries.
  /// \return for each whether it moved; of a scan none: those of noisy ones have climbed in full().
  std::vector<bool> climb(std::vector<Candidate>& candidates) const;

private:
  RefinementStage fullStage() const;
  RefinementStage stage(int num_samples, double sigma, double final_sigma, int max_iterations) const;
  std::vector<Candidate> refined(std::vector<Candidate> candidates, const RefinementStage& stage) const;
  std::vector<Candidate> withinCells(const std::vector<Candidate>& candidates, const std::vector<Candidate>& starts,
                                     const PlaneGrid& grid) const;
  std::vector<Candidate> distinct(std::vector<Candidate> candidates, double least_merit, std::size_t most) const;
  RefinementStage closeStage() const;

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  const DetectionOptions& options_;
};

}  // namespace pcl_symmetry
