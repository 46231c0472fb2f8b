#pragma once

#include <Eigen/Core>
#include <optional>

#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// A single view inferred from the points.
struct InferredView {
  Visibility seen;           ///< what the scanner saw from the viewpoint
  Eigen::Vector3d position;  ///< the viewpoint, frame of the points
  bool as_stored = false;  ///< whether the viewpoint is the stored one, which explains the points as well as any other
};

/// Determines from the points alone whether they are a single view, and from where. Not in the paper.
///
/// The density of the points (ScanDensity) determines direction, side and distance. A viewpoint is accepted if it
/// explains a good part of the variance of the density, and if each ray meets the cloud once; of several viewpoints,
/// the one with the fewest layers. If it leaves less than a quarter of the variance, more layers are allowed, and
/// clouds as thin as wires.
///
/// No viewpoint is found for
/// - whole objects, open shells, cut clouds, and several views put together;
/// - flat sheets of even density, and wires: rays from everywhere meet them once;
/// - single views whose density a voxel grid made even, as open shells look the same;
/// - clouds of fewer than 300 points, whose density is not known well enough.
/// \param points 3 x N, finite.
/// \param stored a viewpoint that may be a default, frame of the points. It is preferred if it explains the points as
/// well as the best one.
/// \param may_be_default false: the stored viewpoint is accepted at once if the points can have been seen from there.
/// \return nothing if the points show no viewpoint.
std::optional<InferredView> inferView(const PointsRef& points, const Eigen::Vector3d& stored,
                                      bool may_be_default = true);

}  // namespace pcl_symmetry
