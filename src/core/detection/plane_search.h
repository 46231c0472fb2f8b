#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/detection/plane_lattice.h"
#include "core/detection/plane_measure.h"
#include "core/detection/staged_refinement.h"

namespace pcl_symmetry {

struct DetectionEvidence;

/// Combined evidence of the planes of a family.
struct JudgedFamily {
  double confidence = 0.0;      ///< confidence of the mean evidence
  double min_confidence = 1.0;  ///< least confidence of a single plane
  double score = 0.0, support = 0.0;
};

/// Fits, refines, measures and judges the planes of a cloud: decides which are symmetries and which are possible
/// (src/pages/algorithms/decision.md).
class PlaneSearch {
public:
  const NormalizedCloud& cloud;
  const Points& all_points;  ///< the points of the cloud and those removed to make it evenly dense, normalized frame
  const DetectionOptions& options;
  const std::unique_ptr<PlaneFit> fit = makePlaneFit(cloud, options);
  const StagedRefinement refinement{cloud, *fit, options};
  const PlaneMeasure measure{cloud, *fit, options};

  /// Cloud, points and options must outlive this object.
  PlaneSearch(const NormalizedCloud& given_cloud, const Points& points, const DetectionOptions& given_options)
      : cloud(given_cloud), all_points(points), options(given_options) {}

  /// \param candidates after the last stage of refinement.
  /// \return one plane per candidate, in the same order.
  std::vector<MeasuredPlane> judge(const std::vector<Candidate>& candidates) const;

  /// The same for some of the candidates, replacing their previous judgments.
  void judge(const std::vector<Candidate>& candidates, const std::vector<char>& some,
             std::vector<MeasuredPlane>& judged) const;

  /// \param plane normalized frame.
  /// \param samples indices of the points that judge it.
  MeasuredPlane judge(const ReflectionPlane& plane, const std::vector<int>& samples) const;

  /// Judges the planes of a family together.
  /// \param planes normalized frame, at least one.
  /// \param samples indices of the points that judge them.
  JudgedFamily judgeFamily(const std::vector<ReflectionPlane>& planes, const std::vector<int>& samples) const;

  /// Whether too many points are off the surface for a possible symmetry of a complete shape.
  bool isHopeless(const Candidate& candidate) const;

  /// Refines and judges candidates; re-judges those that hill climbing moved.
  std::vector<SymmetryPlane> refinedAndJudged(std::vector<Candidate> candidates) const;

private:
  /// Sets the confidence of a plane from its evidence and the limits of the cloud.
  /// \param plane normalized frame.
  MeasuredPlane decided(MeasuredPlane measured, const ReflectionPlane& plane) const;
};

/// Results found so far, input frame.
struct Found : Detection {
  std::optional<PlaneLattice> polygon;    ///< normalized frame; its planes are among `planes`
  DetectionEvidence* evidence = nullptr;  ///< filled with the evidence of all candidates; may be null
};

/// Refines approximately known planes and decides each of them, without searching for others.
/// \param starts input frame.
/// \param input points and what a scanner saw.
std::vector<SymmetryPlane> refinedAt(const std::vector<ReflectionPlane>& starts, const PlaneInput& input,
                                     const DetectionOptions& options);

}  // namespace pcl_symmetry
