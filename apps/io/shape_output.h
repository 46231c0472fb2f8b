/// Results appear under their final name whole, or not at all.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>
#include <functional>
#include <string>

#include "command_line/tool_errors.h"
#include "io/cloud_files.h"

namespace pcl_symmetry::apps {

/// Calls the writer with a temporary name beside `path` (same extension) and renames what it wrote. The temporary file
/// is removed if the writer throws and if the program is interrupted or terminated by a signal. With the path "-" the
/// bytes go to standard output.
/// \throws InputError if the folder is missing or not writable, or the writer made no file; whatever the writer throws.
void writeAtomically(const std::string& path, const std::function<void(const std::string& temporary_path)>& writer);

/// Makes a folder for outputs and those that hold it, unless they are there.
/// \throws InputError if it cannot be made.
void makeFolder(const std::string& path);

/// Writes text, e.g. JSON, as it is.
void writeText(const std::string& path, const std::string& text);

/// Writes a cloud with all its fields and the pose of the sensor; PCD or (binary) PLY by the extension of the name;
/// PCD to standard output, "-".
/// \throws InputError for another extension, an empty cloud, or a file that cannot be written.
void saveCloud(const std::string& path, const pcl::PCLPointCloud2& cloud, const Eigen::Vector4f& sensor_origin,
               const Eigen::Quaternionf& sensor_orientation, PCDEncoding encoding = PCDEncoding::BinaryCompressed);

/// \throws UsageError unless saveCloud() knows the extension; lets a tool refuse before the long work.
void checkCloudExtension(const std::string& path);

}  // namespace pcl_symmetry::apps
