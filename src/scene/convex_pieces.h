#pragma once

#include <vector>

#include "pcl_symmetry/symmetry_scene.h"

namespace pcl_symmetry::detail {

/// Separates objects that touch: PCL's supervoxels and locally convex connected patches cut a cluster where its surface
/// bends inwards, as between a box and another one that leans on it.
/// \param cluster indices of finite points.
/// \param viewpoint position of the sensor, which distinguishes inside from outside.
/// \param spacing spacing of neighboring points, input units, > 0.
/// \param min_points least number of points of a piece; points of smaller ones belong to the nearest piece.
/// \return the pieces, most points first, which together hold all points of the cluster.
std::vector<pcl::Indices> convexPieces(const SymmetryScene::Cloud& scene, const pcl::Indices& cluster,
                                       const Eigen::Vector3d& viewpoint, double spacing, int min_points);

}  // namespace pcl_symmetry::detail
