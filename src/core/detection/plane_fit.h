#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "core/detection/detection_rules.h"
#include "core/refinement/iterative_symmetric_points.h"
#include "core/refinement/normalized_cloud.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// How samples support one plane.
struct PlaneShares {
  double support;        ///< mean over the samples: the reflection lies on the surface
  double conflict;       ///< mean over the samples: the reflection lies where there is nothing
  PointEvidence points;  ///< of each sample
};

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

/// One stage of refinement: how many samples are reflected, how wide the weights are, how often.
///
/// Candidates whose merit is too low for a symmetry never settle, and take fewer samples and iterations.
struct RefinementStage {
  int num_samples;        ///< for likely symmetries
  int num_rough_samples;  ///< for other candidates
  IspOptions isp;         ///< for likely symmetries
  IspOptions rough_isp;   ///< for other candidates
  double min_merit;       ///< merit of likely symmetries
  bool undo_slides;       ///< scans: whether slides along flat pieces are undone, as where the weights are narrowest
  bool climbs = false;    ///< whether planes of noisy scans climb, in the last stage
};

/// How well a cloud supports a plane, and the plane nearby that it supports best.
///
/// There are two forms: SurfaceFit for points that resolve a surface, and VolumeFit for points that do not.
class PlaneFit {
public:
  virtual ~PlaneFit() = default;

  /// Moves each candidate to the best plane nearby, and updates its merit.
  virtual void refine(std::vector<Candidate>& candidates, const RefinementStage& stage) const = 0;

  /// Moves candidates that stopped near their optimum there, and updates their merit; takes as long as all stages. A
  /// density has no pairs without a true partner, so its planes need not climb.
  /// \param stage the last one.
  /// \param may_climb of each candidate.
  /// \return whether each candidate moved.
  virtual std::vector<char> climb(std::vector<Candidate>&, const RefinementStage&,
                                  const std::vector<char>& may_climb) const {
    return std::vector<char>(may_climb.size(), false);
  }

  /// The best plane nearby, at the narrowest weights.
  /// \param samples indices of points.
  /// \param max_iterations >= 1.
  virtual ReflectionPlane refined(const ReflectionPlane& plane, const std::vector<int>& samples,
                                  int max_iterations) const = 0;

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

  /// Ranks candidates: grows with the support, falls with the conflict; about 1 for a symmetry, and may exceed it.
  virtual double merit(const PlaneShares& shares) const = 0;

  /// Support that the samples of a symmetry reach.
  double baseline() const { return kKindRules.resolves_surface[cloud_.kind()] ? cloud_.baseline : 1.0; }

  /// Support as a share of that, in [0, 1].
  double relativeSupport(const PlaneShares& shares) const { return std::min(1.0, shares.support / baseline()); }

protected:
  PlaneFit(const NormalizedCloud& cloud, const DetectionOptions& options) : cloud_(cloud), options_(options) {}

  const NormalizedCloud& cloud_;
  const DetectionOptions& options_;
};

/// Support of each point by the surface, also where the points resolve none; NaN as in PointEvidence::seenSupport().
std::vector<float> surfaceSupport(const NormalizedCloud& cloud, const ReflectionPlane& plane,
                                  const DetectionOptions& options);

/// \param cloud,options must outlive the result.
/// \return the form that fits the cloud.
std::unique_ptr<PlaneFit> makePlaneFit(const NormalizedCloud& cloud, const DetectionOptions& options);

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
  std::vector<Candidate> refineCoarsely(std::vector<Candidate> candidates, const PlaneGrid& grid) const;

  /// More samples; the weights end as narrow as the spacing of the points allows.
  std::vector<Candidate> refineClosely(std::vector<Candidate> candidates) const;

  /// The same for reflections of symmetries, which must be symmetries themselves.
  std::vector<Candidate> refineSymmetries(std::vector<Candidate> candidates) const;

  /// All samples at the narrowest weights: this stage decides the precision of the planes.
  std::vector<Candidate> refineFully(std::vector<Candidate> candidates) const;

  /// Moves planes of a whole cloud to their optimum where pairs without a true partner pull them aside.
  /// \param candidates after refineFully(), in which planes of noisy scans have climbed.
  /// \param may_climb of each candidate: it may be a symmetry.
  /// \return whether each candidate moved.
  std::vector<char> climb(std::vector<Candidate>& candidates, const std::vector<char>& may_climb) const;

  /// The best candidate of each group of like planes, best first: all that may be symmetries, and others until there
  /// are \p most.
  std::vector<Candidate> distinct(std::vector<Candidate> candidates, double min_merit = -1.0,
                                  std::size_t most = std::numeric_limits<std::size_t>::max()) const;

private:
  /// The width of the weights between the first and the second stage.
  double coarseSigma() const;
  RefinementStage closeStage() const;
  RefinementStage fullStage() const;
  RefinementStage stage(int num_samples, double sigma, double final_sigma, int max_iterations) const;
  std::vector<Candidate> refined(std::vector<Candidate> candidates, const RefinementStage& stage) const;
  std::vector<Candidate> withinCells(const std::vector<Candidate>& candidates, const std::vector<Candidate>& starts,
                                     const PlaneGrid& grid) const;

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  const DetectionOptions& options_;
};

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
