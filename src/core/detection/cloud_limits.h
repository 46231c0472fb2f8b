#pragma once

#include <vector>

#include "core/evidence/plane_confidence.h"
#include "core/geometry/principal_axes.h"
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
  std::vector<const char*> of(const ReflectionPlane& plane, const PointsRef& points) const;

private:
  bool is_resolved_, is_cut_;
  double still_;  ///< distance that moves nothing
  Thinness thinness_;
};

}  // namespace pcl_symmetry
