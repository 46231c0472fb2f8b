#pragma once

#include <Eigen/Core>
#include <vector>

#include "pcl_symmetry/core/geometry/reflection_plane.h"
#include "pcl_symmetry/core/scan/visibility.h"
#include "pcl_symmetry/scene/symmetry_scene.h"

namespace pcl_symmetry::detail {

/// Two parts of a cluster, each with a plane that may explain it.
struct TouchingParts {
  pcl::Indices first, second;  ///< into the scene, rising
};

/// Cuts of a cluster into two objects that touch and stand on one support, by planes upright on it: one plane maps one
/// part onto itself or to places that nobody saw, but much of the other part to where the sensor saw that there is
/// nothing, and the other plane the other way round. The idea is that of segmenting clutter by symmetry (Ecins,
/// Fermueller and Aloimonos 2018).
/// \param seen of the scene.
/// \param support that the cluster stands on: unit normal towards it, then d.
/// \param least number of points of a part.
/// \param stands height over the support within which a part has to begin, input units.
/// \return the cuts that explain most, best first, a few that differ.
std::vector<TouchingParts> touchingParts(const SymmetryScene::Cloud& scene, const pcl::Indices& cluster,
                                         const Visibility& seen, const Eigen::Vector4d& support, int least,
                                         double stands);

/// \return share of the points that a plane maps to where the sensor saw that there is nothing, in [0, 1].
double contradictedShare(const SymmetryScene::Cloud& scene, const pcl::Indices& points, const Visibility& seen,
                         const ReflectionPlane& plane);

/// \return height over a plane that 99 of 100 points are above.
double footOf(const SymmetryScene::Cloud& scene, const pcl::Indices& points, const Eigen::Vector4d& support);

}  // namespace pcl_symmetry::detail
