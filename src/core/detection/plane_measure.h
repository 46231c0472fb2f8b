#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <vector>

#include "core/detection/plane_fit.h"
#include "core/evidence/missing_surface.h"
#include "core/evidence/plane_confidence.h"
#include "core/evidence/split_surface.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/cloud_extent.h"
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
    double diameter;    ///< of the points, by farthestPair()
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
  bool is_one_side_;  ///< a scan of one flat side, and what it stands on is not known
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

}  // namespace pcl_symmetry
