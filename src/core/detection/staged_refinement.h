#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/detection/plane_fit.h"

namespace pcl_symmetry {

/// The strongest local maxima of the map, each basin of refinement once, and the planes across the principal axes.
/// \param map over planes in the input frame.
std::vector<Candidate> gatherCandidates(const NormalizedCloud& cloud, const SymmetryMap& map,
                                        const DetectionOptions& options);

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
  std::vector<char> climb(std::vector<Candidate>& candidates) const;

  /// The best candidate of each group of like planes, best first: all that may be symmetries, and others until there
  /// are \p most.
  std::vector<Candidate> distinct(std::vector<Candidate> candidates, double min_merit = -1.0,
                                  std::size_t most = std::numeric_limits<std::size_t>::max()) const;

private:
  RefinementStage fullStage() const;
  RefinementStage stage(int num_samples, double sigma, double final_sigma, int max_iterations) const;
  std::vector<Candidate> refined(std::vector<Candidate> candidates, const RefinementStage& stage) const;
  std::vector<Candidate> withinCells(const std::vector<Candidate>& candidates, const std::vector<Candidate>& starts,
                                     const PlaneGrid& grid) const;
  RefinementStage closeStage() const;

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  const DetectionOptions& options_;
};

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
