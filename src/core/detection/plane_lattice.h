#pragma once

#include <optional>
#include <vector>

#include "core/detection/detection_rules.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry {

/// Whether a plane contains a line, within 3 degrees and \p tolerance.
bool contains(const ReflectionPlane& plane, const Line3d& line, double tolerance);

/// The planes of a regular polygon: \p fold planes through a line, at equal angles.
struct PlaneLattice {
  Line3d line;
  int fold = 0;        ///< number of planes, >= 3
  double phase = 0.0;  ///< angle of the normal of plane 0 from line.direction().unitOrthogonal(), radians
  int num_planes = 0;  ///< that were found

  /// \param k of any sign, may be a fraction: k + 0.5 lies halfway between two planes.
  ReflectionPlane plane(double k) const;
};

/// The lattice that most planes through one line fit.
/// \param planes normalized frame, most certain first.
/// \return none where planes fit none better than chance would have it.
std::optional<PlaneLattice> findLattice(const std::vector<ReflectionPlane>& planes);

}  // namespace pcl_symmetry
