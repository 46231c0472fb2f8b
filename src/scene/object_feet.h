#pragma once

#include <vector>

#include "pcl_symmetry/symmetry_scene.h"

namespace pcl_symmetry::detail {

/// How far the noise lets points of a support rise above it around a cluster.
/// \param spacing of the points, input units, > 0.
/// \param distance of points of one object, input units, > 0.
/// \return input units, > 0; infinity where few points of the support are around the cluster.
double riseOfNoise(const SymmetryScene::Cloud& scene, const SupportingPlane& support, const pcl::Indices& cluster,
                   double spacing, double distance);

/// Gives objects their feet back: points that were taken for the plane that an object stands on, as they lie within its
/// distance, but that rise above the plane around the object by more than the noise does.
///
/// Without its feet, a box looks lower than it is: as high as it is deep, it gets a plane of symmetry between the two.
/// \param supports lose these points.
/// \param clusters gain these points, each the cluster that is nearest to it.
/// \param spacing of the points, input units, > 0.
/// \param distance of a foot from the other points of its cluster, input units, > 0.
void returnFeet(const SymmetryScene::Cloud::ConstPtr& scene, std::vector<SupportingPlane>& supports,
                std::vector<pcl::Indices>& clusters, double spacing, double distance);

}  // namespace pcl_symmetry::detail
