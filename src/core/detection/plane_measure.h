#pragma once

#include <array>
#include <mutex>
#include <optional>
#include <vector>

#include "core/detection/plane_fit.h"
#include "core/evidence/missing_surface.h"
#include "core/evidence/split_surface.h"
#include "core/geometry/principal_axes.h"
#include "pcl_symmetry/core/detect_planes.h"

namespace pcl_symmetry {

/// What was measured of one plane: the evidence that decisions are taken from, and what is reported beside it.
struct PlaneRecord {
  ReflectionPlane plane;             ///< normalized frame
  PlaneEvidence evidence;            ///< all that a decision reads
  std::vector<float> point_support;  ///< of each sample, in [0, 1]
  double seen = 1.0;                 ///< SymmetryPlane::seen
  double told = 1.0;                 ///< share of the samples that move and land where something is known
  double deviation = 0.0;            ///< SymmetryPlane::deviation, normalized frame
  double residual = 0.0;             ///< SymmetryPlane::residual, normalized frame
  int iterations = 0;                ///< SymmetryPlane::iterations
  bool converged = false;            ///< SymmetryPlane::converged
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

  /// Share of the outline of an organized scan at which the picture cut it off; 0 of other clouds.
  double cutShare() const { return cut_share_; }

  /// What is left of the cloud at the tolerance.
  Thinness thinness() const { return thinness_; }

  /// \return indices of the points that planes are judged by.
  std::vector<int> samples() const;

  /// \param candidate after the last stage of refinement.
  /// \param samples what samples() returned.
  PlaneRecord of(const Candidate& candidate, const std::vector<int>& samples) const;

  /// \param plane normalized frame.
  /// \param samples indices of points.
  /// \param rim how far beside a reflection the scanner must have seen nothing, too, for the reflection to contradict.
  PlaneRecord of(const ReflectionPlane& plane, const std::vector<int>& samples, double rim = 0.0) const;

  /// Evidence of the cloud; fields of the plane beyond support, conflict and D keep their defaults.
  PlaneEvidence evidenceOf(double support, double conflict, double score) const;

  /// Share of the surface that a plane maps to within the tolerance, by a look at some points, and its standard error.
  struct QuickShare {
    double share, error;
  };
  /// \param candidate from the second stage of refinement on.
  QuickShare quickShare(const Candidate& candidate) const;

  /// SymmetryPlane::deviation of a plane that maps many points far from the surface, normalized frame.
  double deviation(const ReflectionPlane& plane) const;

  /// Share of the points that a plane moves by more than what is left of a thin cloud at the tolerance.
  double movedShare(const ReflectionPlane& plane) const;

private:
  /// The reflections of some samples, and how far they are off the surface.
  struct Reflected {
    Points points;
    std::vector<float> distances;
  };
  /// What the reflections tell at the tolerance.
  struct Agreement {
    double share;         ///< within the tolerance, of the informative ones
    double double_share;  ///< the same within twice the tolerance
    double hold;          ///< how firmly those within the tolerance hold the plane; 0 where nothing is missing
    double unknown;       ///< uninformative
    double deviation;     ///< distance that 97 % of the informative ones stay within
    double told;          ///< of all samples, those that move and land where something is known; 1 of whole clouds
  };

  /// How near to a line points are one: where there are few, noise of the line is wider than what they resolve.
  double lineTolerance() const;
  double deviationOf(std::vector<float> distances) const;
  Reflected reflected(const ReflectionPlane& plane, const std::vector<int>& samples, const IspStep& step) const;
  Points matchedNormals(const IspStep& step) const;
  /// Whether the scanner saw that nothing is at a point, nor within \p rim beside it: the rim of what was seen is as
  /// exact as its pixels.
  bool isSeenEmpty(const Eigen::Vector3d& x, double rim) const;
  /// For each sample without a match, whether nothing is known of its counterpart, in [0, 1].
  std::vector<float> unknownMatches(const Reflected& reflected, const IspStep& step, const std::vector<char>& matched,
                                    double offset_stiffness, double rim) const;
  Agreement agreement(const ReflectionPlane& plane, const Reflected& reflected, const IspStep& step, double rim) const;
  /// Whether a plane moves a point, or its reflection, so far that this is informative.
  bool moves(const ReflectionPlane& plane, const Eigen::Vector3f& x) const;
  /// The distances of those whose position is informative: of scans without what the plane leaves in place.
  std::vector<float> movedOnly(const std::vector<float>& distances, const ReflectionPlane& plane,
                               const Points& reflected) const;
  PlaneRecord recordOf(const ReflectionPlane& plane, const std::vector<int>& samples, const IspStep& step,
                       double rim) const;
  const SurfaceEnds& ends() const;

  const NormalizedCloud& cloud_;
  const PlaneFit& fit_;
  const DetectionOptions& options_;
  double resolution_, tolerance_, cut_share_;
  Thinness thinness_;
  std::optional<SplitSurface> halves_;  ///< of points that resolve no surface
  /// Within one and two tolerances, of the points themselves and the surface of the others.
  std::array<double, 2> own_shares_;
  double own_score_;  ///< PlaneEvidence::own_score
  mutable std::once_flag ends_found_;
  mutable std::optional<SurfaceEnds> ends_;  ///< found when ends() is first called
};

}  // namespace pcl_symmetry
