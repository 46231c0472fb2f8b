#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <vector>

#include "core/detection/cloud_limits.h"
#include "core/detection/plane_fit.h"
#include "core/evidence/missing_surface.h"
#include "core/evidence/surface_samples.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

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
  MeasuredPlane of(const Candidate& candidate, const std::vector<int>& samples) const;

  /// \param plane normalized frame.
  /// \param samples indices of points.
  /// \param rim how far beside a reflection the scanner must have seen nothing, too, for the reflection to contradict.
  MeasuredPlane of(const ReflectionPlane& plane, const std::vector<int>& samples, double rim = 0.0) const;

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
  /// The distance within which as many lie as 97 % of those of a true plane do within the tolerance.
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
  /// Within one and two tolerances, of the points themselves and the surface of the others.
  std::array<double, 2> own_shares_;
  double own_score_;  ///< PlaneEvidence::own_score
  mutable std::once_flag ends_found_;
  mutable std::optional<SurfaceEnds> ends_;  ///< found when ends() is first called
};

}  // namespace pcl_symmetry
