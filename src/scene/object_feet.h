#pragma once

#include <vector>

#include "pcl_symmetry/symmetry_scene.h"
#include "scene/scene_parts.h"

namespace pcl_symmetry::detail {

/// How far the noise lets points of a support rise above it around a cluster.
/// \return input units, > 0; infinity where few points of the support are around the cluster.
double riseOfNoise(const SymmetryScene::Cloud& scene, const SupportingPlane& support, const pcl::Indices& cluster,
                   const SceneDistances& distances);

/// Gives objects their feet back: points that were taken for the plane that an object stands on, as they lie within its
/// distance, but that rise above the plane around the object by more than the noise does.
///
/// Without its feet, a box looks lower than it is: as high as it is deep, it gets a plane of symmetry between the two.
/// \param supports lose these points.
/// \param clusters gain these points, each the cluster that is nearest to it.
/// \param distances a foot is as close to the other points of its cluster as these are to each other.
void returnFeet(const SymmetryScene::Cloud& scene, std::vector<SupportingPlane>& supports,
                std::vector<pcl::Indices>& clusters, const SceneDistances& distances);

}  // namespace pcl_symmetry::detail
