#pragma once

#include <vector>

#include "core/detection/plane_decision.h"
#include "core/detection/plane_measure.h"
#include "core/detection/turn_signs.h"

namespace pcl_symmetry {

/// A plane, and what the decision was taken from.
struct JudgedPlane {
  SymmetryPlane plane;  ///< input frame
  PlaneEvidence evidence;
};

/// What the decisions of one detection were taken from: what fits are made to.
struct DetectionEvidence {
  /// Candidates after all stages of refinement, each plane once, best merit first. No fitted number has a part in them.
  std::vector<JudgedPlane> planes;
  std::vector<JudgedTurn> turns;  ///< of scans
};

/// What the planes of a family say together.
struct JudgedFamily {
  double confidence = 0.0;        ///< of the mean evidence
  double least_confidence = 1.0;  ///< of a single plane
  double score = 0.0, support = 0.0;
};

/// From refined planes to answers: measures, then decides.
class PlaneJudge {
public:
  /// \param cloud,fit,options must outlive this object.
  PlaneJudge(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options)
      : measure(cloud, fit, options), decision(cloud, measure, options), cloud_(cloud), options_(options) {}
  PlaneJudge(const PlaneJudge&) = delete;  // parts refer to each other
  PlaneJudge& operator=(const PlaneJudge&) = delete;

  const PlaneMeasure measure;
  const PlaneDecision decision;

  /// \param candidates after the last stage of refinement.
  /// \return one plane each, input frame, in the same order.
  std::vector<SymmetryPlane> judge(const std::vector<Candidate>& candidates) const;

  /// The same with the evidence.
  std::vector<JudgedPlane> judgeWithEvidence(const std::vector<Candidate>& candidates) const;

  /// Planes of a family together.
  /// \param planes normalized frame, at least one.
  /// \param samples indices of the points that judge them.
  JudgedFamily judgeFamily(const std::vector<ReflectionPlane>& planes, const std::vector<int>& samples) const;

private:
  const NormalizedCloud& cloud_;
  const DetectionOptions& options_;
};

}  // namespace pcl_symmetry
