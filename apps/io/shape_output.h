/// Results appear under their final name complete, or not at all.
#pragma once

#include <pcl/PCLPointCloud2.h>

#include <Eigen/Geometry>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

enum class PCDEncoding { Ascii, Binary, BinaryCompressed };

/// Lets a tool fail before the long work begins.
/// \throws InputError if no file of this name can be made: the folder is missing, it is a folder, or isForeignShape().
void checkTarget(const std::string& path);

/// \return whether none of the outputs is "-", so that standard output is free for text.
/// \throws UsageError if several are.
bool isStandardOutputFree(const std::vector<std::optional<std::string>>& outputs);

/// All outputs of tools are written in this way: to a temporary file beside `path`, which is renamed when it is
/// complete. It is removed if the disk is full, if the writer throws and if a signal ends the program. With the path
/// "-", the bytes go to standard output; pipes and devices are written directly.
/// \throws InputError if the folder is missing or not writable or the disk is full; whatever the writer throws.
void writeStream(const std::string& path, const std::function<void(std::ostream&)>& writer);

/// The same for writers of libraries that need the name of a file: they get the name of a file in memory.
/// \param comment line that is inserted after the first line of a PCD file, the second of a PLY file.
/// \throws InputError also if the writer made no file.
void writeAtomically(const std::string& path, const std::function<void(const std::string& file_in_memory)>& writer,
                     const std::string& comment = "");

/// Makes a folder for outputs, and its parents, unless they exist.
/// \throws InputError if it cannot be made.
void makeFolder(const std::string& path);

/// Writes text unchanged.
void writeText(const std::string& path, const std::string& text);

/// Writes a cloud with all its fields and the pose of the sensor, by default none; PCD or (binary) PLY by the extension
/// of the name; PCD to standard output, "-".
/// \throws InputError for another extension, an empty cloud, or a file that cannot be written.
void saveCloud(const std::string& path, const pcl::PCLPointCloud2& cloud,
               const Eigen::Vector4f& sensor_origin = Eigen::Vector4f::Zero(),
               const Eigen::Quaternionf& sensor_orientation = Eigen::Quaternionf::Identity(),
               PCDEncoding encoding = PCDEncoding::BinaryCompressed);

/// \throws UsageError unless saveCloud() supports the extension; lets a tool fail before the long work begins.
void checkCloudExtension(const std::string& path);

/// Name of the tool, which is in a comment in the header of the clouds and meshes that it writes.
std::string& toolName();

/// \return whether there is a cloud, mesh or volume that this tool did not write: perhaps an input.
bool isForeignShape(const std::string& path);

/// PCL's writers, in the module pcl_symmetry_cloud_files.
/// \param extension ".ply" or ".pcd"; the encoding applies to PCD.
/// \return false, or throws what PCL throws, if PCL reports a failure; it does not notice all failures.
extern "C" bool writeCloudFile(const std::string& path, const std::string& extension, const pcl::PCLPointCloud2& cloud,
                               const Eigen::Vector4f& origin, const Eigen::Quaternionf& orientation,
                               PCDEncoding encoding);

}  // namespace pcl_symmetry::apps
