#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/detection/plane_lattice.h"
#include "core/detection/plane_measure.h"
#include "core/detection/staged_refinement.h"
#include "core/detection/standing_object.h"
#include "core/rotation/rotation_evidence.h"

namespace pcl_symmetry {

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
  /// Unit normals of the supports that carry the object of a scan.
  const std::vector<Eigen::Vector3d> support_normals;

  /// Cloud, points and options must outlive this object.
  PlaneSearch(const NormalizedCloud& given_cloud, const Points& points, const DetectionOptions& given_options)
      : cloud(given_cloud),
        all_points(points),
        options(given_options),
        support_normals(cloud.isScan() ? supportNormals(cloud.points, *cloud.seen()) : std::vector<Eigen::Vector3d>()) {
  }

  /// \param candidates after the last stage of refinement.
  /// \return one plane per candidate, in the same order.
  std::vector<MeasuredPlane> judge(const std::vector<Candidate>& candidates) const;

  /// The same for some of the candidates, replacing their previous judgments.
  void rejudge(const std::vector<Candidate>& candidates, const std::vector<char>& chosen,
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
  std::vector<SymmetryPlane> refineAndJudge(std::vector<Candidate> candidates) const;

private:
  /// Sets the confidence of a plane from its evidence and the limits of the cloud.
  /// \param plane normalized frame.
  MeasuredPlane decide(MeasuredPlane measured, const ReflectionPlane& plane) const;
};

/// The evidence behind the decisions of one detection, to which confidences are fitted.
struct DetectionEvidence {
  /// Candidates after all stages of refinement, each plane once, best merit first. They do not depend on fitted
  /// numbers.
  std::vector<MeasuredPlane> planes;
  std::vector<JudgedRotation> rotations;  ///< of scans
};

/// Results found so far, input frame.
struct DetectionState {
  Detection answer;
  std::optional<PlaneLattice> polygon;    ///< normalized frame; its planes are among the planes of the answer
  DetectionEvidence* evidence = nullptr;  ///< filled with the evidence of all candidates; may be null
};

/// Refines approximately known planes and decides each of them, without searching for others.
/// \param starts input frame.
/// \param input points and what a scanner saw.
std::vector<SymmetryPlane> refinePlanes(const std::vector<ReflectionPlane>& starts, const PlaneInput& input,
                                        const DetectionOptions& options);

/// detectPlanes(), with the evidence of its decisions.
/// \param evidence filled with the evidence of all candidates (doubles the time); may be null.
Detection detectWithEvidence(const PlaneInput& input, const DetectionOptions& options, DetectionEvidence* evidence);

}  // namespace pcl_symmetry
