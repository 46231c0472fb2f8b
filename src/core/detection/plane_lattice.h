#pragma once

#include <optional>

#include "core/detection/detection_rules.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

class PlaneSearch;
struct DetectionState;

/// Whether a plane contains a line, normalized frame, within kDetection.families.
bool contains(const ReflectionPlane& plane, const Line3d& line);

/// The planes of a regular polygon: \p fold planes through a line, at equal angles.
struct PlaneLattice {
  Line3d line;
  int fold = 0;        ///< number of planes, >= 3
  double phase = 0.0;  ///< angle of the normal of plane 0 from line.direction().unitOrthogonal(), radians

  /// \param k of any sign, may be a fraction: k + 0.5 lies halfway between two planes.
  ReflectionPlane plane(double k) const;
};

/// Finds the regular polygon of a noisy cloud about a line: the density of points in rings about the line, as a
/// function of the angle, has one strong frequency. It sums over all points and finds folds that no single plane shows.
/// \param all the points of the cloud and those removed to make it evenly dense, normalized frame.
/// \param line normalized frame.
/// \return nothing if no frequency stands out: no rotation maps the cloud onto itself, or all rotations do.
std::optional<PlaneLattice> latticeBySpectrum(const Points& all, const Line3d& line);

/// Completes polygons. Planes of noisy clouds are judged jointly: all of them are symmetries or none is. Planes of
/// surfaces can be judged individually, but with many teeth they are too close to be found one by one.
void completePolygon(const PlaneSearch& search, DetectionState& state);

}  // namespace pcl_symmetry
