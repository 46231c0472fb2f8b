#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "core/detection/candidates.h"
#include "core/detection/detection_rules.h"
#include "core/refinement/iterative_symmetric_points.h"
#include "core/refinement/normalized_cloud.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// How samples support one plane.
struct PlaneShares {
  double support;        ///< mean over the samples of how well the reflection lies on the surface, in [0, 1]
  double conflict;       ///< mean over the samples of how well the reflection lies in free space, in [0, 1]
  PointEvidence points;  ///< evidence of each sample
};

/// One stage of refinement: how many samples are reflected, how wide the weights are, and how many iterations are made.
///
/// Candidates whose merit is too low for a symmetry never settle: they take fewer samples and iterations.
struct RefinementStage {
  int num_samples;        ///< samples that likely symmetries reflect
  int num_rough_samples;  ///< samples that other candidates reflect
  IspOptions isp;         ///< options for likely symmetries
  IspOptions rough_isp;   ///< options for other candidates
  double min_merit;       ///< least merit of likely symmetries
  bool undo_slides;       ///< whether slides of scans along flat pieces are undone (with the narrowest weights)
  bool climbs = false;    ///< whether planes of noisy scans climb, in the last stage
};

/// Measures how well a cloud supports a plane, and finds the best-supported plane nearby.
///
/// There are two forms: SurfaceFit for points that resolve a surface, and VolumeFit for points that do not.
class PlaneFit {
public:
  virtual ~PlaneFit() = default;

  /// Moves each candidate to the best plane nearby, and updates its merit.
  virtual std::vector<Candidate> refine(std::vector<Candidate> candidates, const RefinementStage& stage) const = 0;

  /// Moves candidates that stopped near their optimum to it and updates their merit; this takes as long as all stages
  /// together. Densities have no false pairs, so their planes need not climb.
  /// \param stage the last stage.
  /// \param may_climb whether each candidate may be a symmetry.
  /// \return whether each candidate moved.
  virtual std::vector<char> climb(std::vector<Candidate>&, const RefinementStage&,
                                  const std::vector<char>& may_climb) const {
    return std::vector<char>(may_climb.size(), false);
  }

  /// The best plane nearby, at the narrowest weights.
  /// \param samples indices of points.
  virtual ReflectionPlane refinePlane(const ReflectionPlane& plane, const std::vector<int>& samples) const = 0;

  /// \param samples indices of points.
  /// \param step closest points to the reflections of these samples.
  virtual PlaneShares shares(const ReflectionPlane& plane, const std::vector<int>& samples,
                             const IspStep& step) const = 0;

  PlaneShares shares(const ReflectionPlane& plane, const std::vector<int>& samples) const {
    return shares(plane, samples, matches(plane, samples));
  }

  /// The closest points to the reflections of some samples, within reach of the narrowest weights.
  /// \param guesses IspStep::closest of a plane nearby, which makes the search faster; null = not known.
  IspStep matches(const ReflectionPlane& plane, const std::vector<int>& samples,
                  const std::vector<int>* guesses = nullptr) const {
    return matchSymmetricPoints(cloud_.surface, samples, plane, cloud_.final_sigma, guesses);
  }

  /// Criterion by which candidates are ranked: grows with the support, falls with the conflict; about 1 for a symmetry,
  /// and may exceed it.
  virtual double merit(const PlaneShares& shares) const = 0;

  /// Support that the samples of a symmetry reach.
  double baseline() const { return cloud_.isVolume() ? 1.0 : cloud_.baseline; }

  /// Support relative to baseline(), in [0, 1].
  double relativeSupport(const PlaneShares& shares) const { return std::min(1.0, shares.support / baseline()); }

protected:
  PlaneFit(const NormalizedCloud& cloud, const DetectionOptions& options) : cloud_(cloud), options_(options) {}

  const NormalizedCloud& cloud_;
  const DetectionOptions& options_;
};

/// Support of each point by the surface, also for points that resolve no surface; NaN as in
/// PointEvidence::seenSupport().
std::vector<float> surfaceSupport(const NormalizedCloud& cloud, const ReflectionPlane& plane,
                                  const DetectionOptions& options);

/// \param cloud,options must outlive the result.
/// \return SurfaceFit or VolumeFit, as suits the cloud.
std::unique_ptr<PlaneFit> makePlaneFit(const NormalizedCloud& cloud, const DetectionOptions& options);

}  // namespace pcl_symmetry
