#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/detection/plane_fit.h"

namespace pcl_symmetry {

/// Refines candidates to precise planes in three stages, each with more samples and narrower weights than the one
/// before (Section 4.4).
///
/// After each of the first two stages, candidates at the same plane are merged, and in whole clouds only the best of
/// those that are no symmetries are kept.
struct StagedRefinement {
  const NormalizedCloud& cloud;
  const PlaneFit& fit;
  const DetectionOptions& options;

  /// Few samples and wide weights: most candidates end in a basin that another one found, or leave their cell.
  /// \param grid the grid of the map, whose cells candidates from the map must not leave.
  std::vector<Candidate> refineCoarsely(std::vector<Candidate> candidates, const PlaneGrid& grid) const;

  /// More samples; the weights end as narrow as the spacing of the points allows.
  std::vector<Candidate> refineClosely(std::vector<Candidate> candidates) const;

  /// The same for reflections of symmetries, which must be symmetries themselves.
  std::vector<Candidate> refineSymmetries(std::vector<Candidate> candidates) const;

  /// All samples at the narrowest weights: this stage decides the precision of the planes.
  std::vector<Candidate> refineFully(std::vector<Candidate> candidates) const;

  /// Moves planes of a whole cloud to their optimum where pairs without a true partner pull them aside.
  /// \param candidates result of refineFully(), in which planes of noisy scans have climbed.
  /// \param may_climb whether each candidate may be a symmetry.
  /// \return whether each candidate moved.
  std::vector<char> climb(std::vector<Candidate>& candidates, const std::vector<char>& may_climb) const;

  /// The best candidate of each group of similar planes, best first: all that may be symmetries, and others up to a
  /// total of \p max_count.
  std::vector<Candidate> distinct(std::vector<Candidate> candidates,
                                  std::size_t max_count = std::numeric_limits<std::size_t>::max(),
                                  double min_merit = -1.0) const;

private:
  /// The width of the weights between the first and the second stage.
  double coarseSigma() const;
  RefinementStage closeStage() const;
  RefinementStage fullStage() const;
  RefinementStage stage(int num_samples, double sigma, double final_sigma, int max_iterations) const;
  std::vector<Candidate> withinCells(const std::vector<Candidate>& candidates, const std::vector<Candidate>& starts,
                                     const PlaneGrid& grid) const;
};

}  // namespace pcl_symmetry
