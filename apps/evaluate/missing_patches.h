/// Scans with holes, as shiny and dark spots leave them.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>

namespace pcl_symmetry::apps {

/// Makes points not finite: round patches about points drawn at random, 4 % of the points each, until \p share of the
/// finite ones is gone.
/// \param share in [0, 1).
void removePatches(pcl::PointCloud<pcl::PointXYZ>& cloud, double share, std::uint64_t seed);

}  // namespace pcl_symmetry::apps
