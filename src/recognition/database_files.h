#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <string>
#include <vector>

#include "core/views/view_signature.h"

namespace pcl_symmetry::detail {

/// File formats of a database. Every function throws pcl::IOException, which names the file and the reason.

using PositionCloud = pcl::PointCloud<pcl::PointXYZ>;

/// \throws pcl::IOException always.
[[noreturn]] void failIO(const std::string& file, const std::string& reason);

/// 32-bit floats in the byte order of the machine.
void writeFloats(const std::string& path, const std::vector<float>& values);
std::vector<float> readFloats(const std::string& path);

/// A binary PCD file with the fields x, y and z.
void writeCloud(const std::string& path, const PositionCloud& cloud);
/// \param path of a file that writeCloud() wrote.
PositionCloud readCloud(const std::string& path);

/// For each view: its signature, its radius and the upper three rows of its pose.
void writeViews(const std::string& path, const std::vector<View>& views);
std::vector<View> readViews(const std::string& path);

}  // namespace pcl_symmetry::detail
