/// Reads PCD files.
///
/// Not by pcl::PCDReader: its library takes longer to load (30 ms) than a tool takes to find planes, and it crashes on
/// files that promise what they do not hold.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>
#include <string>

namespace pcl_symmetry::apps {

struct PCDCloud {
  pcl::PCLPointCloud2 cloud;  ///< all fields of the file without padding, one after the other
  Eigen::Vector4f sensor_origin = Eigen::Vector4f::Zero();
  Eigen::Quaternionf sensor_orientation = Eigen::Quaternionf::Identity();
};

/// \param path a PCD file with fields x, y and z: ascii, binary or binary_compressed.
/// \throws InputError naming the field, its value and the rule, where sizes and counts do not agree with each other and
/// with the file, or where text holds what is no number.
PCDCloud readPCD(const std::string& path);

}  // namespace pcl_symmetry::apps
