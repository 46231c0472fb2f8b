#pragma once

#include <optional>
#include <vector>

#include "core/detection/plane_fit.h"
#include "core/detection/plane_lattice.h"
#include "core/detection/plane_measure.h"
#include "core/detection/turn_confidence.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// The supports that carry an object, see Visibility::withSupport(): the nearest one and those that it touches, too.
/// \param points of the object, 3 x N, finite, N >= 1.
/// \return their unit normals.
std::vector<Eigen::Vector3d> carryingNormals(const PointsRef& points, const Visibility& seen);

/// The kind that a confidence alone gives a plane.
PlaneKind kindOf(double confidence, const DetectionOptions& options);

/// True where a plane is neither upright nor level on any of these supports; false without one.
bool slants(const ReflectionPlane& plane, const std::vector<Eigen::Vector3d>& carrying_normals);

/// From evidence to answers: the one place that says what is a symmetry, what is possible, and what comes first
/// (core/evidence/README.md).
class PlaneDecision {
public:
  /// \param cloud,measure,options must outlive this object.
  PlaneDecision(const NormalizedCloud& cloud, const PlaneMeasure& measure, const DetectionOptions& options)
      : cloud_(cloud), measure_(measure), options_(options) {}

  /// \return the plane in the input frame, with its confidence and kind.
  SymmetryPlane decide(PlaneRecord record) const;

  /// Gives a plane another confidence, and the kind that follows from it.
  /// \param plane input frame.
  void decideBy(double confidence, SymmetryPlane& plane) const;

  /// Whether the picture cuts the cloud off all around: a place, such as a table, and no object.
  bool isCutAllAround() const;

  /// Whether a plane explains all of a whole cloud, so that nothing of it is missing.
  bool explainsAll(const SymmetryPlane& plane) const;

  /// Whether too many points are off for a possible symmetry where nothing is missing.
  bool isHopeless(const Candidate& candidate) const;

  /// Where a plane explains all of a cloud, nothing of it is missing: doubts planes that need a missing piece (the
  /// plane across an open cup needs a lid).
  void preferWhole(std::vector<SymmetryPlane>& planes) const;

  /// A scan or a cut hides a part of an object, and many planes are tried: those beside the best one are symmetries
  /// less often.
  /// \param has_family an axis or a center was found, which is better than all planes.
  void preferBest(std::vector<SymmetryPlane>& planes, bool has_family) const;

  /// What stands on a table was made to stand there, or lies on one of its sides, and then its planes are upright or
  /// level, but for few: doubts those that slant. Where nothing is known of a support, no plane does.
  /// \param planes the answer; those that are doubted go behind the others, and out where they are not even possible.
  void doubtSlanted(std::vector<SymmetryPlane>& planes) const;

private:
  /// Whether the sensor resolves the tolerance, or no tolerance that counts.
  bool isResolved() const;
  PlaneKind kindOf(const ReflectionPlane& plane, double confidence) const;

  const NormalizedCloud& cloud_;
  const PlaneMeasure& measure_;
  const DetectionOptions& options_;
};

/// Rank of a kind: 0 for symmetries, 1 for possible ones, 2 for others.
int rankOf(const SymmetryPlane& plane);

/// The order of answers: symmetries, then possible ones, both by falling confidence, then others by falling support.
bool isBetter(const SymmetryPlane& a, const SymmetryPlane& b);

/// True of symmetries and possible ones.
inline bool isDecided(const SymmetryPlane& plane) {
  return rankOf(plane) < 2;
}

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

/// What the planes of a family tell together.
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

/// The planes that are reported: best first, each maximum once, as many as the options ask for.
///
/// Order: symmetries, then possible ones, both by falling confidence, then approximate and local ones by falling
/// support.
/// \param planes input frame.
/// \param polygon whose planes are all of them maxima, normalized frame.
/// \return with the support of every point.
std::vector<SymmetryPlane> rankedPlanes(std::vector<SymmetryPlane> planes, const std::optional<PlaneLattice>& polygon,
                                        const NormalizedCloud& cloud, const PlaneFit& fit,
                                        const DetectionOptions& options);

/// \return the plane of a cloud of which nothing but a sheet is left at the tolerance, input frame; else empty.
std::optional<ReflectionPlane> flatPlane(const NormalizedCloud& cloud, Thinness thinness);

/// The answer where nothing is a symmetry: of the planes of the whole, the one with the greatest share.
/// \param planes input frame.
/// \return with the support of every point; empty where a plane is a symmetry or a possible one, or there is none.
std::optional<SymmetryPlane> bestApproximate(const std::vector<SymmetryPlane>& planes, const NormalizedCloud& cloud,
                                             const PlaneFit& fit);

}  // namespace pcl_symmetry
