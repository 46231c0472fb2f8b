#pragma once

#include <Eigen/Core>
#include <optional>

#include "pcl_symmetry/core/visibility.h"

namespace pcl_symmetry {

/// A single view that the points themselves show.
struct InferredView {
  Visibility seen;           ///< from the viewpoint that was found
  Eigen::Vector3d position;  ///< the viewpoint, frame of the points
  bool as_stored = false;    ///< the viewpoint is the stored one, which explains the points as well as any
};

/// Finds out from the points alone whether they are a single view, and from where.
///
/// Not in the paper. The density of the points decides (ScanDensity): it has a direction, a side and a distance. The
/// view is believed if it explains a good part of the variance of the density and if each ray meets the cloud once.
/// Where the best viewpoint is not, others that explain as much are tried, and the one with the fewest layers is taken.
/// Whole objects, open shells, cut clouds and several views put together have none: so do flat sheets of even density,
/// which are seen once from everywhere. Single views of which a voxel grid has evened out the density have none either:
/// nothing tells them from open shells. Neither have fewer than 300 points, whose density is known too little, nor
/// wires, which are seen once from everywhere. Where a viewpoint leaves less than a quarter of the variance, and of
/// what points at random have, the cloud may lie in more layers, and be as thin as a wire.
/// \param points 3 x N, finite.
/// \param stored a viewpoint that may be a default, frame of the points. It is preferred where it explains the points
/// as well as the best.
/// \return nothing where the points show no viewpoint.
std::optional<InferredView> inferView(const PointsRef& points, const Eigen::Vector3d& stored);

}  // namespace pcl_symmetry
