/// Which way the surface looks at each point, for its shading.
#pragma once

#include "pictures/patch_geometry.h"
#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry::apps {

/// More points shade themselves by their density. chosen: half leaves medium clouds flat, twice takes twice the time.
constexpr std::size_t kMaxShadedPoints = 200'000;

/// \return 3 x N, unit, of arbitrary sign, one for each point; not finite where the point is not, and for clouds of
/// fewer than 16 or more than kMaxShadedPoints points.
Points pointNormals(const pcl::PointCloud<pcl::PointXYZ>& points, const Normalization& normalize);

}  // namespace pcl_symmetry::apps
