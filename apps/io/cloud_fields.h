/// Moves and extends clouds of any fields.
#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/types.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

namespace pcl_symmetry::apps {

/// Moves the points from \p first on: x, y, z and the viewpoint vp_x, vp_y, vp_z by the whole map, normals by its
/// linear part. Other fields stay.
/// \param map keeps distances: a rigid motion or a reflection.
void movePoints(pcl::PCLPointCloud2& cloud, const Eigen::Affine3d& map, std::size_t first = 0);

/// One more field of type float for each name, after those that the cloud has.
/// \param values for each name one value per point.
/// \throws InputError where a name is taken.
pcl::PCLPointCloud2 withFields(const pcl::PCLPointCloud2& cloud, const std::vector<std::string>& names,
                               const std::vector<std::vector<float>>& values);

/// Appends copies of the named points; the result is not organized. One more field of type int32 tells of each copy the
/// index of the point that it was made of, and is -1 for all others.
pcl::PCLPointCloud2 appendCopies(const pcl::PCLPointCloud2& cloud, const pcl::Indices& points,
                                 const std::string& field_name);

}  // namespace pcl_symmetry::apps
