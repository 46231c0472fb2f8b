#pragma once

#include <optional>
#include <vector>

#include "core/detection/plane_lattice.h"
#include "core/detection/plane_measure.h"
#include "core/detection/set_confidence.h"
#include "core/rotation/rotation_evidence.h"

namespace pcl_symmetry {

/// The evidence behind the decisions of one detection, to which confidences are fitted.
struct DetectionEvidence {
  /// Candidates after all stages of refinement, each plane once, best merit first. No fitted number has a part in them.
  std::vector<MeasuredPlane> planes;
  std::vector<JudgedRotation> rotations;  ///< of scans
};

/// Combined evidence of the planes of a family.
struct JudgedFamily {
  double confidence = 0.0;      ///< of the mean evidence
  double min_confidence = 1.0;  ///< of a single plane
  double score = 0.0, support = 0.0;
};

/// From measured planes to answers: decides what is a symmetry, what is possible, and what comes first
/// (core/evidence/README.md).
class PlaneDecision {
public:
  /// \param cloud,measure,options must outlive this object.
  PlaneDecision(const NormalizedCloud& cloud, const PlaneMeasure& measure, const DetectionOptions& options)
      : cloud_(cloud), measure_(measure), options_(options) {}

  /// \param candidates after the last stage of refinement.
  /// \return one plane each, in the same order.
  std::vector<MeasuredPlane> judge(const std::vector<Candidate>& candidates) const;

  /// \param plane normalized frame.
  /// \param samples indices of the points that judge it.
  MeasuredPlane judge(const ReflectionPlane& plane, const std::vector<int>& samples) const;

  /// Planes of a family together.
  /// \param planes normalized frame, at least one.
  /// \param samples indices of the points that judge them.
  JudgedFamily judgeFamily(const std::vector<ReflectionPlane>& planes, const std::vector<int>& samples) const;

  /// PlaneMeasure::tolerance().
  double tolerance() const { return measure_.tolerance(); }

  /// CloudLimits::isCutAllAround().
  bool isCutAllAround() const { return measure_.limits().isCutAllAround(); }

  /// Whether too many points are off for a possible symmetry where nothing is missing.
  bool isHopeless(const Candidate& candidate) const;

  /// Whether all points lie within the tolerance of one line.
  bool isLine() const { return measure_.limits().thinness() == Thinness::Line; }

private:
  /// Gives a plane the confidence that its evidence has, and the limits of the cloud.
  /// \param plane normalized frame.
  MeasuredPlane decided(MeasuredPlane measured, const ReflectionPlane& plane) const;

  const NormalizedCloud& cloud_;
  const PlaneMeasure& measure_;
  const DetectionOptions& options_;
};

/// The planes that are reported: best first, each maximum once, at most DetectionOptions::max_planes.
///
/// Order: symmetries, then possible ones, both by falling confidence, then approximate and local ones by falling
/// support.
/// \param planes input frame.
/// \param polygon normalized frame; each of its planes is a maximum.
/// \return with the support of every point.
std::vector<SymmetryPlane> rankedPlanes(std::vector<SymmetryPlane> planes, const std::optional<PlaneLattice>& polygon,
                                        const NormalizedCloud& cloud, const PlaneFit& fit,
                                        const DetectionOptions& options);

/// Planes in the order of answers, without `approximate` only those that are decided.
std::vector<SymmetryPlane> reordered(std::vector<SymmetryPlane> planes, const DetectionOptions& options);

/// \return the plane of a cloud of which nothing but a sheet is left at the tolerance, input frame; else empty.
std::optional<ReflectionPlane> flatPlane(const NormalizedCloud& cloud, const CloudLimits& limits);

/// The answer where nothing is a symmetry: of the planes of the whole, the one with the greatest share.
/// \param planes input frame.
/// \return with the support of every point; empty where a plane is a symmetry or a possible one, or there is none.
std::optional<SymmetryPlane> bestApproximate(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                             const PlaneFit& fit);

}  // namespace pcl_symmetry
