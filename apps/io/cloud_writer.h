/// Writes clouds with PCL, in the module pcl_symmetry_cloud_files.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>
#include <string>

namespace pcl_symmetry::apps {

enum class PCDEncoding { Ascii, Binary, BinaryCompressed };

/// \param extension ".ply" or ".pcd"; the encoding is that of PCD.
/// \return false, or throws what PCL throws, where PCL reports a failure; it does not notice all.
extern "C" bool writeCloudFile(const std::string& path, const std::string& extension, const pcl::PCLPointCloud2& cloud,
                               const Eigen::Vector4f& origin, const Eigen::Quaternionf& orientation,
                               PCDEncoding encoding);

}  // namespace pcl_symmetry::apps
