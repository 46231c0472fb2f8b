#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/detection/plane_families.h"
#include "core/detection/plane_fit.h"
#include "core/evidence/missing_surface.h"
#include "core/evidence/plane_confidence.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/cloud_extent.h"
#include "core/rotation/rotation_evidence.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// What a cloud cannot decide, whatever the evidence: its sensor resolves less than the tolerance, a picture cuts it
/// off all around, or a plane moves no more than the tolerance: a sheet is mapped onto itself by its own plane, and a
/// line by all. Such planes are possible symmetries at most.
class CloudLimits {
public:
  /// Lengths in units of the points.
  struct Lengths {
    double tolerance;   ///< > 0
    double resolution;  ///< the least tolerance that the sensor resolves; 0 where its errors are not known
    double spacing;     ///< of the points
    double diameter;    ///< greatest distance between two points
  };

  /// \param points 3 x N, finite, N >= 1.
  /// \param axes of the points.
  /// \param seen what a scanner saw, frame of the points; null = the points show the object from all sides.
  CloudLimits(const PointsRef& points, const PrincipalAxes& axes, CloudKind kind, const Visibility* seen,
              const Lengths& lengths);

  /// What is left of the cloud at the tolerance.
  Thinness thinness() const { return thinness_; }

  /// Whether the border of the picture cuts the cloud off all around: a piece of the surroundings, such as a table top,
  /// not an object.
  bool isCutAllAround() const { return is_cut_; }

  /// Whether a reflection leaves most points of a sheet where they are.
  /// \param plane frame of the points.
  /// \param points those of the cloud.
  bool movesNothing(const ReflectionPlane& plane, const PointsRef& points) const;

  /// \param plane frame of the points.
  /// \param points those of the cloud.
  /// \return the rules that keep a plane from being more than possible, each in a few words.
  std::vector<const char*> rulesAgainst(const ReflectionPlane& plane, const PointsRef& points) const;

private:
  bool is_resolved_, is_cut_;
  double still_;  ///< distance that moves nothing
  Thinness thinness_;
};

/// A plane, and what its decision is taken from.
struct MeasuredPlane {
  SymmetryPlane plane;       ///< input frame
  PlaneEvidence evidence;    ///< all that the decision reads, beside informative
  double informative = 1.0;  ///< share of the samples that move and land where something is known; 1 of whole clouds
};

/// Measures how much of a cloud planes map onto the cloud, and how much of it is uninformative. It decides nothing.
class PlaneMeasure {
public:
  /// \param cloud,fit,options must outlive this object.
  PlaneMeasure(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options);

  /// How far a symmetric surface may be off, normalized frame.
  double tolerance() const { return tolerance_; }

  /// The least tolerance that the sensor resolves, normalized frame; 0 where its errors are not known.
  double resolution() const { return resolution_; }

  /// What the cloud cannot decide.
  const CloudLimits& limits() const { return limits_; }

  /// \return indices of the points that planes are judged by.
  std::vector<int> samples() const;

  /// \param candidate after the last stage of refinement.
  /// \param samples what samples() returned.
  /// \return without confidence and kind, as below.
  MeasuredPlane measured(const Candidate& candidate, const std::vector<int>& samples) const;

  /// \param plane normalized frame.
  /// \param samples indices of points.
  /// \param rim how far beside a reflection the scanner must have seen nothing, too, for the reflection to contradict.
  MeasuredPlane measured(const ReflectionPlane& plane, const std::vector<int>& samples, double rim = 0.0) const;

  /// Evidence of the cloud; fields of the plane beyond support, conflict and D keep their defaults.
  PlaneEvidence evidenceOf(double support, double conflict, double score) const;

  /// Share of the surface that a plane maps to within the tolerance, by a look at some points, and its standard error.
  struct ScreenedShare {
    double share, error;
  };
  /// \param candidate from the second stage of refinement on.
  ScreenedShare screenedShare(const Candidate& candidate) const;

  /// SymmetryPlane::deviation of a plane that maps many points far from the surface, normalized frame.
  double deviation(const ReflectionPlane& plane) const;

private:
  /// The distance within which 97 % of the samples lie, relative to what sampling and noise allow.
  double deviationOf(std::vector<float> distances) const;
  /// Where the reflections of some samples land.
  /// \param closest points to them.
  Landing landed(const ReflectionPlane& plane, const std::vector<int>& samples, std::vector<int> closest) const;
  /// For each sample without a match, whether nothing is known of its counterpart, in [0, 1].
  std::vector<float> unknownMatches(const Landing& landing, const std::vector<char>& matched, double offset_stiffness,
                                    double rim) const;
  /// \param rim as above.
  MeasuredPlane measured(const ReflectionPlane& plane, const std::vector<int>& samples, const IspStep& step,
                         double rim) const;
  const SurfaceEnds& ends() const;

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  const DetectionOptions& options_;
  double resolution_, tolerance_;
  CloudLimits limits_;
  std::optional<SplitSurface> halves_;  ///< of points that resolve no surface
  /// Shares of the points within one and two tolerances of the surface of the others.
  std::array<double, 2> own_shares_;
  double own_score_;  ///< PlaneEvidence::own_score
  mutable std::once_flag ends_found_;
  mutable std::optional<SurfaceEnds> ends_;  ///< found when ends() is first called
};

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

  /// The same for some of the candidates, in place of what they were judged before.
  void judge(const std::vector<Candidate>& candidates, const std::vector<char>& some,
             std::vector<MeasuredPlane>& judged) const;

  /// \param plane normalized frame.
  /// \param samples indices of the points that judge it.
  MeasuredPlane judge(const ReflectionPlane& plane, const std::vector<int>& samples) const;

  /// Planes of a family together.
  /// \param planes normalized frame, at least one.
  /// \param samples indices of the points that judge them.
  JudgedFamily judgeFamily(const std::vector<ReflectionPlane>& planes, const std::vector<int>& samples) const;

  /// Whether too many points are off for a possible symmetry where nothing is missing.
  bool isHopeless(const Candidate& candidate) const;

private:
  /// Gives a plane the confidence that its evidence has, and the limits of the cloud.
  /// \param plane normalized frame.
  MeasuredPlane decided(MeasuredPlane measured, const ReflectionPlane& plane) const;

  const NormalizedCloud& cloud_;
  const PlaneMeasure& measure_;
  const DetectionOptions& options_;
};

/// A cloud, and what fits, refines, measures and judges its planes. Cloud, points and options must outlive it.
struct JudgedCloud {
  const NormalizedCloud& cloud;
  const Points& all_points;  ///< its points and those that were left out to make it evenly dense, normalized frame
  const DetectionOptions& options;
  const std::unique_ptr<PlaneFit> fit = makePlaneFit(cloud, options);
  const StagedRefinement refinement{cloud, *fit, options};
  const PlaneMeasure measure{cloud, *fit, options};
  const PlaneDecision decision{cloud, measure, options};

  JudgedCloud(const NormalizedCloud& given_cloud, const Points& points, const DetectionOptions& given_options)
      : cloud(given_cloud), all_points(points), options(given_options) {}

  /// Refines and judges candidates; re-judges those that hill climbing moved.
  std::vector<SymmetryPlane> refinedAndJudged(std::vector<Candidate> candidates) const;
};

/// What was found up to now, input frame.
struct Found : Detection {
  std::optional<PlaneLattice> polygon;  ///< normalized frame; its planes are among the planes
};

/// Refines planes that are nearly known and decides each of them; no others are searched.
/// \param starts input frame.
/// \param input points and what a scanner saw.
std::vector<SymmetryPlane> refinedAt(const std::vector<ReflectionPlane>& starts, const PlaneInput& input,
                                     const DetectionOptions& options);

/// The planes that are reported: best first, each maximum once, at most DetectionOptions::max_planes.
///
/// Order: symmetries, then possible ones, both by falling confidence, then approximate and local ones by falling
/// support.
/// \param planes input frame.
/// \param polygon normalized frame; each of its planes is a maximum.
/// \return with the support of every point.
std::vector<SymmetryPlane> rankedPlanes(const JudgedCloud& judged, std::vector<SymmetryPlane> planes,
                                        const std::optional<PlaneLattice>& polygon = std::nullopt);

/// Planes in the order of answers, without `approximate` only those that are decided.
std::vector<SymmetryPlane> reordered(std::vector<SymmetryPlane> planes, const DetectionOptions& options);

/// \return the plane of a cloud that is a sheet at the tolerance, input frame; else empty.
std::optional<ReflectionPlane> flatPlane(const JudgedCloud& judged);

/// The answer where nothing is a symmetry: of the planes of the whole, the one with the greatest share.
/// \param planes input frame.
/// \return with the support of every point; empty where a plane is a symmetry or a possible one, or there is none.
std::optional<SymmetryPlane> bestApproximate(const JudgedCloud& judged, const std::vector<SymmetryPlane>& planes);

// The only functions that write the confidence, the kind and the reasons of a plane of a whole, whatever was measured:
// a cloud, a mesh, a volume, an upright box or a polygon; and the rules that lower its odds by what was found beside
// it. Not in the paper.

/// Sets the confidence of a plane, and its kind from min_confidence and min_possible. The evidence replaces all that
/// came before; what limits the plane to a possible symmetry stays.
/// \param confidence in [0, 1].
/// \param evidence what was measured, as Reason::rule.
void setConfidence(SymmetryPlane& plane, double confidence, const char* evidence, const DetectionOptions& options);

/// Sets another confidence by a rule that looks beside the evidence.
/// \param confidence in [0, 1].
void changeConfidence(SymmetryPlane& plane, double confidence, const char* rule, const DetectionOptions& options);

/// The same by a factor on the odds.
/// \param odds > 0; nothing changes at 1.
void multiplyOdds(SymmetryPlane& plane, double odds, const char* rule, const DetectionOptions& options);

/// From now on the plane is a possible symmetry at most, whatever sets its confidence.
void limitToPossible(SymmetryPlane& plane, const char* rule);

/// Whether a plane is a symmetry or a possible one.
inline bool isDecided(const SymmetryPlane& plane) {
  return plane.kind == PlaneKind::Symmetry || plane.kind == PlaneKind::Possible;
}

/// Whether a plane explains all of a whole cloud, so that nothing of it is missing.
bool explainsAll(const SymmetryPlane& plane, CloudKind kind);

/// Where a plane explains all of a cloud, nothing of it is missing: those that need a missing piece are doubted, such
/// as the plane across an open cup, which needs a lid.
/// \param planes of the whole, also those that follow from others.
void doubtMissingPieces(std::vector<SymmetryPlane>& planes, CloudKind kind, const DetectionOptions& options);

/// A scan or a cut hides a part of an object, and many planes are tried: those beside the best one, or beside a
/// family, are symmetries less often.
/// \param has_family an axis or a center was found, which is better than all planes.
void doubtFurtherPlanes(std::vector<SymmetryPlane>& planes, bool has_family, CloudKind kind,
                        const DetectionOptions& options);

/// An object on a table was made to stand there, or lies on one of its sides: nearly all of its planes are upright or
/// level. Without a known support, no plane is slanted.
/// \param carrying_normals as from carryingNormals().
void doubtSlantedPlanes(std::vector<SymmetryPlane>& planes, const std::vector<Eigen::Vector3d>& carrying_normals,
                        const DetectionOptions& options);

}  // namespace pcl_symmetry
