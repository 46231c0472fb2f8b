#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <string>
#include <vector>

#include "core/views/view_signature.h"

namespace pcl_symmetry {

/// Files of a database. All throw pcl::IOException naming the file.

using PositionCloud = pcl::PointCloud<pcl::PointXYZ>;

[[noreturn]] void failIO(const std::string& file, const std::string& why);

void writeFloats(const std::string& path, const std::vector<float>& values);
std::vector<float> readFloats(const std::string& path);

/// A PCD file of x, y and z.
void writeCloud(const std::string& path, const PositionCloud& cloud);
/// \param path of a file of writeCloud().
PositionCloud readCloud(const std::string& path);

void writeViews(const std::string& path, const std::vector<View>& views);
std::vector<View> readViews(const std::string& path);

}  // namespace pcl_symmetry
