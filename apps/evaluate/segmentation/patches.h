/// Takes patches out of clouds, as occlusion and drop-outs do.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>

namespace pcl_symmetry::apps {

/// Makes a share of the finite points not finite: those nearest to \p num_patches of them drawn at random, each patch
/// as many points.
/// \param share in [0, 1).
void removePatches(pcl::PointCloud<pcl::PointXYZ>& cloud, double share, int num_patches, std::uint64_t seed);

}  // namespace pcl_symmetry::apps
