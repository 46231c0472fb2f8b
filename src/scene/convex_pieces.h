#pragma once

#include <vector>

#include "pcl_symmetry/symmetry_scene.h"

namespace pcl_symmetry::detail {

/// Separates objects that touch: PCL's supervoxels and its locally convex connected patches cut a cluster where its
/// surface bends inwards, as between a box and another one that it leans on.
/// \param cluster indices of finite points.
/// \param viewpoint of the sensor, which tells inside from outside.
/// \param spacing of neighbouring points, input units, > 0.
/// \return the pieces, most points first; pieces of a few supervoxels belong to the neighbor that they share most with.
std::vector<pcl::Indices> convexPieces(const SymmetryScene::Cloud& scene, const pcl::Indices& cluster,
                                       const Eigen::Vector3d& viewpoint, double spacing);

}  // namespace pcl_symmetry::detail
