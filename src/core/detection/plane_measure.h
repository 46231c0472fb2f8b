#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <vector>

#include "core/detection/plane_fit.h"
#include "core/evidence/missing_surface.h"
#include "core/evidence/plane_confidence.h"
#include "core/evidence/point_density.h"
#include "core/evidence/surface_samples.h"
#include "core/geometry/cloud_extent.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// Limits of a cloud that no evidence overcomes: its sensor does not resolve the tolerance, the image border cuts it
/// off, or a plane moves its points by no more than the tolerance, like the plane of a sheet and all planes
/// of a line. Such planes are at most possible symmetries.
class CloudLimits {
public:
  /// Lengths in units of the points.
  struct Lengths {
    double tolerance;   ///< > 0
    double resolution;  ///< least tolerance that the sensor resolves; 0 if its errors are unknown
    double spacing;     ///< median distance of the points
    double diameter;    ///< diameter of the points, by approximateDiameter()
  };

  /// \param points 3 x N, finite, N >= 1.
  /// \param axes principal axes of the points.
  /// \param seen what a scanner saw, frame of the points; null = the points show the object from all sides.
  CloudLimits(const PointsRef& points, const PrincipalAxes& axes, CloudKind kind, const Visibility* seen,
              const Lengths& lengths);

  /// Whether the cloud is solid, a sheet or a line at the tolerance.
  Thinness thinness() const { return thinness_; }

  /// Whether the image border cuts off more of the outline than kDetection.decide.max_cut: then the cloud is part of
  /// the surroundings, such as a table top, and not an object.
  bool isCutOff() const { return is_cut_; }

  /// Whether a reflection leaves most points of a sheet in place.
  /// \param plane frame of the points.
  /// \param points the points of the cloud.
  bool leavesMostInPlace(const ReflectionPlane& plane, const PointsRef& points) const;

  /// \param plane frame of the points.
  /// \param points the points of the cloud.
  /// \return the rules that limit a plane to a possible symmetry, each in a few words.
  std::vector<const char*> rulesAgainst(const ReflectionPlane& plane, const PointsRef& points) const;

private:
  bool is_resolved_, is_cut_;
  double still_;  ///< displacement up to which a point counts as unmoved
  Thinness thinness_;
  bool is_one_side_;  ///< a scan of one flat side whose support is unknown
};

/// A plane and the measurements that decide on it.
struct MeasuredPlane {
  SymmetryPlane plane;       ///< input frame
  PlaneEvidence evidence;    ///< input of the decision, together with informative
  double informative = 1.0;  ///< share of the samples that move and whose images lie in known space; 1 for whole clouds
};

/// Measures how much of a cloud planes map onto the cloud, and how much is uninformative. It makes no decisions.
class PlaneMeasure {
public:
  /// \param cloud,fit,options must outlive this object.
  PlaneMeasure(const NormalizedCloud& cloud, const PlaneFit& fit, const DetectionOptions& options);

  /// Greatest deviation of a symmetric surface, normalized frame.
  double tolerance() const { return tolerance_; }

  /// Least tolerance that the sensor resolves, normalized frame; 0 if its errors are unknown.
  double resolution() const { return resolution_; }

  /// Limits of the cloud.
  const CloudLimits& limits() const { return limits_; }

  /// \return indices of the points that planes are judged by.
  std::vector<int> samples() const;

  /// \param candidate after the last stage of refinement.
  /// \param samples what samples() returned.
  /// \return the measured plane, without confidence and kind.
  MeasuredPlane measureCandidate(const Candidate& candidate, const std::vector<int>& samples) const;

  /// \param plane normalized frame.
  /// \param samples indices of points.
  /// \param rim a reflection contradicts only if the space within this distance on either side is free, too.
  MeasuredPlane measurePlane(const ReflectionPlane& plane, const std::vector<int>& samples, double rim = 0.0) const;

  /// Evidence for a plane with what all planes of the cloud share; `share`, `double_share`, `stiffness` and `unknown`
  /// keep their defaults.
  PlaneEvidence evidenceOf(double support, double conflict, double score) const;

  /// The greatest share of the surface that a plane may map to within the tolerance, as far as some points show.
  /// \param candidate after the second stage of refinement or later.
  double greatestShare(const Candidate& candidate) const;

  /// SymmetryPlane::deviation of a plane that maps many points far from the surface, normalized frame.
  double deviation(const ReflectionPlane& plane) const;

private:
  /// The distance within which 97 % of the samples lie, less the effect of sampling and noise.
  double deviationOf(std::vector<float> distances) const;
  /// The images of some samples and their distances from the surface.
  /// \param closest points of the surface closest to the reflections.
  Landing landingOf(const ReflectionPlane& plane, const std::vector<int>& samples, std::vector<int> closest) const;
  /// For each sample without a match, the certainty that its counterpart lies in unknown space, in [0, 1].
  std::vector<float> unknownMatches(const Landing& landing, const std::vector<char>& matched, double offset_stiffness,
                                    double rim) const;
  /// \param rim as above.
  MeasuredPlane measureMatched(const ReflectionPlane& plane, const std::vector<int>& samples, const IspStep& step,
                               double rim) const;
  const SurfaceEnds& ends() const;

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  const DetectionOptions& options_;
  double resolution_, tolerance_;
  CloudLimits limits_;
  std::optional<SplitSurface> halves_;  ///< the two halves of points that resolve no surface
  /// Shares of the points within one and two tolerances of the surface of the others.
  std::array<double, 2> own_shares_;
  double own_score_;  ///< PlaneEvidence::own_score
  mutable std::once_flag ends_found_;
  mutable std::optional<SurfaceEnds> ends_;  ///< computed when ends() is first called
};

}  // namespace pcl_symmetry
