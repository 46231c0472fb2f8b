#pragma once

#include <optional>
#include <vector>

#include "core/detection/plane_fit.h"

namespace pcl_symmetry {

class PlaneDecision;

/// Whether a plane contains a line, within 3 degrees and \p tolerance.
bool contains(const ReflectionPlane& plane, const Line3d& line,
              double tolerance = kDetection.families.contained_offset);

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

/// The regular polygon about a line that a noisy cloud has: the density of points in rings about the line, by their
/// angle, has one strong frequency. It is the sum over all points, and finds folds that no single plane shows.
/// \param all the points of the cloud and those that were left out to make it evenly dense, normalized frame.
/// \param line normalized frame.
/// \param num_threads 0 = one per core.
/// \return none where no frequency stands out: no rotation maps the cloud onto itself, or all do.
std::optional<PlaneLattice> latticeBySpectrum(const NormalizedCloud& cloud, const Points& all, const Line3d& line,
                                              int num_threads);

struct JudgedCloud;
struct Found;

/// Completes polygons. The planes of noisy clouds are judged together, as they are symmetries together or not at all.
/// Those of surfaces are judged well enough alone, but many teeth leave them too close to be found one by one.
void completePolygon(const JudgedCloud& judged, Found& found);

}  // namespace pcl_symmetry
