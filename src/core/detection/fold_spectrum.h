#pragma once

#include <optional>
#include <vector>

#include "core/detection/plane_decision.h"
#include "core/detection/plane_lattice.h"

namespace pcl_symmetry {

/// The regular polygon about a line that a noisy cloud has: the density of points in rings about the line, by their
/// angle, has one strong frequency. It is the sum over all points, and finds folds that no single plane shows.
/// \param all the points of the cloud and those that were left out to make it evenly dense, normalized frame.
/// \param line normalized frame.
/// \param num_threads 0 = one per core.
/// \return none where no frequency stands out: no rotation maps the cloud onto itself, or all do.
std::optional<PlaneLattice> latticeBySpectrum(const NormalizedCloud& cloud, const Points& all, const Line3d& line,
                                              int num_threads);

struct PlanesAndPolygon {
  std::vector<SymmetryPlane> planes;    ///< input frame
  std::optional<PlaneLattice> polygon;  ///< normalized frame; whose planes are among them as they are symmetries
};

/// Judges the planes of a polygon together, as they are symmetries together or not at all. Only of noisy clouds: where
/// points resolve a surface, each plane is judged well enough alone.
/// \param planes found before, input frame.
/// \param all as above.
PlanesAndPolygon withPolygon(std::vector<SymmetryPlane> planes, const NormalizedCloud& cloud, const Points& all,
                             const PlaneJudge& judge, const DetectionOptions& options);

}  // namespace pcl_symmetry
