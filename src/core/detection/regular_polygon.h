#pragma once

#include <optional>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// The planes of a regular polygon: \p fold planes through a line, at equal angles.
struct RegularPolygon {
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
std::optional<RegularPolygon> polygonBySpectrum(const Points& all, const Line3d& line);

}  // namespace pcl_symmetry
