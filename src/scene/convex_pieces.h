#pragma once

#include <vector>

#include "pcl_symmetry/symmetry_scene.h"

namespace pcl_symmetry::detail {

/// Separates objects that touch: PCL's supervoxels and its locally convex connected patches cut a cluster where its
/// surface bends inwards, as between a box and another one that it leans on.
/// \param cluster indices of finite points.
/// \param viewpoint of the sensor, which tells inside from outside.
/// \param spacing of neighboring points, input units, > 0.
/// \param min_points of a piece; points of smaller ones belong to the nearest piece.
/// \return the pieces, most points first, which hold all points of the cluster.
std::vector<pcl::Indices> convexPieces(const SymmetryScene::Cloud& scene, const pcl::Indices& cluster,
                                       const Eigen::Vector3d& viewpoint, double spacing, int min_points);

}  // namespace pcl_symmetry::detail
