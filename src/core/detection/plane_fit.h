#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/detection/detection_rules.h"
#include "core/evidence/point_density.h"
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
  double merit = 0.0;                                    ///< PlaneFit's criterion after the last stage
};

/// How samples support one plane.
struct PlaneShares {
  double support;        ///< mean over the samples of how well the reflection lies on the surface, in [0, 1]
  double conflict;       ///< mean over the samples of how well the reflection lies in free space, in [0, 1]
  PointEvidence points;  ///< evidence of each sample
};

/// How the surface of a cloud supports a plane, also for points that resolve no surface.
/// \param samples indices of points.
/// \param closest the points closest to the reflections of these samples.
PlaneShares surfaceShares(const NormalizedCloud& cloud, const ReflectionPlane& plane, const std::vector<int>& samples,
                          const std::vector<int>& closest);

/// Measures how well a cloud supports a plane, and refines candidates to precise planes in three stages, each with more
/// samples and narrower weights than the one before (Section 4.4).
///
/// Planes of points that resolve a surface are moved by Iterative Symmetric Points and supported by the share of the
/// points whose reflection lies on the surface; those of other points by the overlap of the points' density with its
/// reflection. After each of the first two stages, candidates at the same plane are merged, and of those whose merit
/// is too low for a symmetry only the best are kept; in a whole cloud that has a symmetry, none after the second stage,
/// unless approximate planes are reported.
class PlaneFit {
public:
  /// \param cloud,options must outlive this object.
  PlaneFit(const NormalizedCloud& cloud, const DetectionOptions& options);

  /// Few samples and wide weights: most candidates end in a basin that another one found, or leave their cell.
  /// \param grid the grid of the map, whose cells candidates from the map must not leave.
  std::vector<Candidate> refineCoarsely(std::vector<Candidate> candidates, const PlaneGrid& grid) const;

  /// More samples; the weights end as narrow as the spacing of the points allows.
  std::vector<Candidate> refineClosely(std::vector<Candidate> candidates) const;

  /// The same for planes implied by symmetries; those with much less merit than a symmetry are dropped.
  std::vector<Candidate> refineImplied(std::vector<Candidate> candidates) const;

  /// All samples at the narrowest weights: this stage decides the precision of the planes.
  std::vector<Candidate> refineFully(std::vector<Candidate> candidates) const;

  /// Moves planes of a whole surface that stopped near their optimum, because pairs without a true partner pull them
  /// aside, to it and updates their merit; this takes as long as all stages together. Densities have no false pairs,
  /// and planes of noisy scans have climbed in refineFully().
  /// \param candidates result of refineFully().
  /// \param may_climb whether each candidate may be a symmetry.
  /// \return whether each candidate moved.
  std::vector<char> climb(std::vector<Candidate>& candidates, const std::vector<char>& may_climb) const;

  /// The best candidate of each group of similar planes, best first: all that may be symmetries, and others up to a
  /// total of \p max_count.
  std::vector<Candidate> distinct(std::vector<Candidate> candidates,
                                  std::size_t max_count = std::numeric_limits<std::size_t>::max(),
                                  double min_merit = -1.0) const;

  /// The best plane nearby, at the narrowest weights.
  /// \param samples indices of points.
  ReflectionPlane refinePlane(const ReflectionPlane& plane, const std::vector<int>& samples) const;

  /// \param samples indices of points.
  /// \param step closest points to the reflections of these samples.
  PlaneShares shares(const ReflectionPlane& plane, const std::vector<int>& samples, const IspStep& step) const;
  PlaneShares shares(const ReflectionPlane& plane, const std::vector<int>& samples) const {
    return shares(plane, samples, matches(plane, samples));
  }

  /// The closest points to the reflections of some samples, within reach of the narrowest weights.
  /// \param guesses IspStep::closest of a plane nearby, which makes the search faster; null = not known.
  IspStep matches(const ReflectionPlane& plane, const std::vector<int>& samples,
                  const std::vector<int>* guesses = nullptr) const {
    return matchSymmetricPoints(cloud_.surface, samples, plane, cloud_.final_sigma, guesses);
  }

  /// Support that the samples of a symmetry reach.
  double baseline() const { return cloud_.isVolume() ? 1.0 : cloud_.baseline; }

  /// Support relative to baseline(), in [0, 1].
  double relativeSupport(const PlaneShares& shares) const { return std::min(1.0, shares.support / baseline()); }

private:
  /// How many samples are reflected, how wide the weights are, and how many iterations are made. Candidates that may be
  /// symmetries are likely ones; others take fewer samples and iterations.
  struct Stage {
    int num_samples;        ///< samples that likely symmetries reflect
    int num_rough_samples;  ///< samples that other candidates reflect
    IspOptions isp;         ///< options for likely symmetries
    IspOptions rough_isp;   ///< options for other candidates
    bool undo_slides;       ///< whether slides of scans along flat pieces are undone (with the narrowest weights)
    bool climbs = false;    ///< whether planes of noisy scans climb, in the last stage
  };

  /// The width of the weights between the first and the second stage.
  double coarseSigma() const;
  Stage closeStage() const;
  Stage fullStage() const;
  Stage stage(int num_samples, double sigma, double final_sigma, int max_iterations) const;
  std::vector<int> drawn(int num_samples) const;

  /// Moves each candidate to the best plane nearby, and updates its merit.
  std::vector<Candidate> refine(std::vector<Candidate> candidates, const Stage& stage) const;
  void refineOnSurface(Candidate& candidate, const Stage& stage, const std::shared_ptr<const std::vector<int>>& samples,
                       const std::shared_ptr<const std::vector<int>>& fewer) const;
  void undoSlide(Candidate& candidate, const ReflectionPlane& start, double sigma) const;
  bool climb(Candidate& candidate, const std::vector<int>& samples, const std::vector<int>& fewer) const;
  std::vector<Candidate> withinCells(const std::vector<Candidate>& candidates, const std::vector<Candidate>& starts,
                                     const PlaneGrid& grid) const;
  /// Criterion by which candidates are ranked: grows with the support, falls with the conflict; about 1 for a symmetry,
  /// and may exceed it.
  double merit(const PlaneShares& shares) const;

  const NormalizedCloud& cloud_;
  const DetectionOptions& options_;
  std::optional<PointDensity> density_;  ///< of points that resolve no surface
};

}  // namespace pcl_symmetry
